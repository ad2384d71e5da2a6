//! The PBR viewport: a model with its maps, lit by an environment and lights, seen by a camera.
//!
//! Directions and places are right-handed with +Y up. What is drawn lies in view space: the model's box is centered and its
//! largest side is 1, so that no model is too small or too large to be seen.

mod camera;
mod dfg;
mod edges;
mod environment;
mod error;
mod frame;
mod model;
mod pick;
mod pipelines;
mod placement;
pub mod relief;
mod renderer;
mod scene;
mod shadows;
mod target;
mod upload;
mod viewport;

pub use camera::{Camera, Lens, Ray, Viewpoint, ViewpointError, aspect_of};
pub use environment::{Environment, Panorama};
pub use error::ViewError;
pub use model::ViewModel;
pub use pick::{Picked, pick};
pub use placement::Placement;
pub use renderer::{Missing, Pose, Renderer};
pub use scene::{
    Background, Light, LightPlace, Lines, MOST_LIGHTS, MaterialLook, Mode, NodeLook, NodeType, Scene, Shot,
    ViewTransform,
};
pub use target::{LONGEST_SIDE, Pixels, Target};
pub use viewport::{Quality, Viewport};
