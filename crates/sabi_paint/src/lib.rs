//! Strokes of a brush on a surface: the data that a `source/paint` node holds.
//!
//! A [`Stroke`] is a brush, an action and points on the surface; pixels are computed from it, at any size. A [`StrokeList`] holds the
//! strokes of one node on one model. Every list that ever existed has a [`Version`], a hash of the step that led to it
//! and of the version before. A graph names the version, so that undo, copies of nodes and cache keys need nothing
//! else. Versions are kept as steps from an earlier version to a later one ([`Step`]) in a [`StrokeBook`], and on disk
//! in a [`mod@file`] to which steps are appended.
//!
//! Invariants:
//! * The same strokes on the same atlas give the same texels on every machine and any number of threads.
//! * A result belongs to the surface: it does not depend on charts, texel size or the rate of events.
//! * A damaged stroke file loses what is damaged and nothing else, and is not written to.
//!
//! Lengths are model units; colors are linear.

mod brush;
mod brush_limits;
mod canvas;
mod canvases;
mod dynamics;
mod fade;
pub mod file;
mod index;
mod list;
mod octahedral;
mod path;
mod path_form;
mod pen;
mod picture;
mod site;
mod stamps;
mod stencil;
mod step_bytes;
mod stroke;
mod stroke_text;
mod supplies;
mod surface;
mod swatch;
mod tips;
mod version;
mod way;

pub use brush::{Brush, Symmetry, SymmetryCopy, TipDirection};
pub use brush_limits::{BrushLimits, Eye};
pub use canvas::{Canvas, CanvasLayers, CanvasTexel, Growth, LaidStroke, Painter};
pub use canvases::{Canvases, PaintedStrokes};
pub use dynamics::Jitter;
pub use fade::{Fade, FadeCurve};
pub use index::SurfaceIndex;
pub use list::{StrokeBook, StrokeList};
pub use path::{Bend, EdgeKind, Knot, Path};
pub use path_form::PathForm;
pub use pen::{PenEffects, Shaft, Touch};
pub use picture::{
    NoPictureName, PictureName, PicturePart, PictureTip, StampPicture, StampPictureError, StampPictures, SwatchPixel,
};
pub use site::{carried, relocate};
pub use stamps::Stamps;
pub use stencil::Stencil;
pub use stroke::{Action, Area, CopyOf, Step, Stroke, StrokeGroup, StrokePoint};
pub use stroke_text::{NoStrokes, is_text_of_strokes, strokes_as_text, strokes_from_text};
pub use supplies::{InputColors, Supplies};
pub use surface::{PaintSurface, StopCheck, decal_axes, rightward};
pub use swatch::{stamp_swatch, swatch};
pub use tips::Tip;
pub use version::Version;
