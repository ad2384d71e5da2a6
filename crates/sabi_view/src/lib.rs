//! The PBR viewport: a model with its maps, lit by an environment and lights.
//!
//! Directions and positions are right-handed with +Y up. Everything is drawn in view space: the model's box is centered and
//! its largest side is 1, so that models of all sizes are treated in the same way.
//!
//! Invariants:
//! * The viewport reads the textures that an evaluation stored: a normal and a color are decoded as an exported map's are.
//! * A picture depends on its [`Scene`], its [`Shot`] and its size alone, not on the picture before.
//! * Cameras and picking are plain values and need no device.
//! * Nothing here knows the graph, files or windows.
//!
//! ```
//! use glam::{Vec2, Vec3};
//! use sabi_view::{Camera, Viewpoint};
//!
//! let camera = Camera::seen_from(Viewpoint::FRONT, &[Vec3::splat(-0.5), Vec3::splat(0.5)], 1.0);
//! let ray = camera.ray(Vec2::splat(0.5), 1.0);
//! assert!(ray.direction.dot(camera.forward()) > 0.999);
//! ```

mod camera;
mod dfg;
mod edges;
mod environment;
mod error;
mod frame;
mod lights;
mod mirrors;
mod model;
mod pick;
mod pipelines;
mod placement;
pub mod relief;
mod render_target;
mod renderer;
mod scene;
mod shade;
mod shaders;
mod shadows;
mod upload;
mod viewport;

pub use camera::{Camera, Lens, Ray, Viewpoint, ViewpointError, aspect_of};
pub use environment::{Environment, Panorama};
pub use error::ViewError;
pub use lights::{STUDIO_ENVIRONMENT_STRENGTH, STUDIO_LIGHTS};
pub use mirrors::mirrors;
pub use model::{ViewModel, ViewModelParts};
pub use pick::{PickedPoint, pick};
pub use placement::Placement;
pub use render_target::{LONGEST_SIDE, Pixels, RenderTarget};
pub use renderer::{MissingPipelines, ModelPose, Renderer};
pub use scene::{
    Background, Light, LightPlace, Lines, MOST_LIGHTS, MaterialLook, Mode, NodeLook, NodeType, Scene, Shot,
    USUAL_BLOOM, ViewTransform,
};
pub use shaders::view_modules;
pub use viewport::{Quality, SceneRevision, Viewport};
