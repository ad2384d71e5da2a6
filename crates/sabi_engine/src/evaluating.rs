//! Evaluation of a graph on a model: plans and runs, and looks, previews and thumbnails of results.

pub(crate) mod evaluated_graph;
pub(crate) mod evaluated_surface;
pub(crate) mod evaluator;
pub(crate) mod looks;
pub(crate) mod outputs;
pub(crate) mod shared_texels;
pub(crate) mod texture_sets;
pub(crate) mod texture_space;
pub(crate) mod thumbnail;

pub use evaluator::{EvaluatorOptions, RaySettings};
pub use looks::{LooksIdentity, ModelLooks, evaluate_looks};
pub use texture_sets::TextureSet;
pub use texture_space::{PlaneKind, ResultPlane};
pub use thumbnail::{load_thumbnail, store_thumbnail, thumbnail_of};
