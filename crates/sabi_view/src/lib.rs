//! The PBR viewport: a model with its maps, lit by an environment and lights, seen by a camera.
//!
//! Directions and places are right-handed with +Y up. What is drawn lies in view space: the model's box is centered and its
//! largest side is 1, so that no model is too small or too large to be seen.

mod camera;
mod dfg;
mod environment;
mod error;
mod pick;
mod placement;

pub use environment::{Environment, Panorama};
pub use camera::{Camera, Lens, Ray, Viewpoint, ViewpointError, aspect_of};
pub use error::ViewError;
pub use pick::{Picked, pick};
pub use placement::Placement;
