//! Pictures of results: a lit model, or one node in texture space.

pub(crate) mod density;
pub(crate) mod displace;
pub(crate) mod node_argument;
pub(crate) mod picture_file;
pub(crate) mod preview;
pub(crate) mod render;
pub(crate) mod stamp_square;

pub use density::Softness;
pub use displace::TriangleLimit;
pub use preview::{PreviewRequest, preview, preview_graph};
pub use render::{RenderRequest, Turns, encode_picture, render, render_graph};
pub use stamp_square::{StampSquare, stamp_square};
