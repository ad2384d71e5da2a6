//! Strokes, and the steps from one list of strokes to the next.

use std::sync::Arc;

use sabi_surface::patch::Site;
use serde::{Deserialize, Serialize};

use crate::brush::Brush;
use crate::brush_limits::Eye;
use crate::path_form::PathForm;
use crate::pen::{Shaft, Touch};
use crate::picture::PictureName;
use crate::stencil::Stencil;
use crate::version::Version;

/// One stroke of a brush.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Identity, which does not change when the stroke is changed: the version in which the stroke was added.
    pub id: Version,
    /// Name given by the artist; empty if there is none.
    pub name: String,
    /// The brush.
    pub brush: Brush,
    /// Action of the brush.
    pub action: Action,
    /// Area on which the brush acts.
    pub area: Area,
    /// True if the stroke is hidden, so that it has no effect.
    pub is_hidden: bool,
    /// Eye of the artist while the stroke was drawn; `None` in the 2D view.
    pub eye: Option<Eye>,
    /// Place that [`Action::Clone`] copies to the first point.
    pub source: Option<StrokePoint>,
    /// Source of [`Action::Clone`]: the paint, or a node result.
    pub copy_of: CopyOf,
    /// The group that it belongs to.
    pub group: Option<Arc<StrokeGroup>>,
    /// Bends of the path that it follows; `None` if it was drawn by hand.
    pub path: Option<PathForm>,
    /// Picture in front of the view through which the stroke was painted.
    pub stencil: Option<Arc<Stencil>>,
    /// Points that it passes, in order; for a path its knots and handles ([`Stroke::as_path`]).
    pub points: Vec<StrokePoint>,
}

impl Stroke {
    /// Returns true if its paint depends on the paint below it.
    pub fn depends_on_paint(&self) -> bool {
        self.changes_paint() || self.area == Area::Similar
    }

    /// Returns true if it changes or copies existing paint, or copies from another place. A copy of a node result in place
    /// is painted like a color.
    pub(crate) fn changes_paint(&self) -> bool {
        self.action.adjusts() && !self.copies_in_place()
    }

    /// Returns true if it copies the result that is connected to the node, at each place itself.
    pub(crate) fn copies_in_place(&self) -> bool {
        self.copies_input() && self.source.is_none()
    }

    /// Returns true if it copies the result that is connected to the node.
    pub fn copies_input(&self) -> bool {
        self.action == Action::Clone && self.copy_of == CopyOf::Input
    }

    /// Returns true if it has no effect, since it or its group is hidden.
    pub fn leaves_nothing(&self) -> bool {
        self.is_hidden || self.group.as_ref().is_some_and(|group| group.is_hidden)
    }

    /// Returns the pictures that it needs: those of its brush and of its stencil.
    pub fn pictures(&self) -> impl Iterator<Item = &PictureName> {
        let of_stencil = self.stencil.as_ref().map(|stencil| &stencil.picture);
        let tips = self.brush.picture.iter().chain(of_stencil);
        tips.map(|tip| &tip.picture)
    }

    /// Creates a stroke that paints along its way, without a name. It receives its id from [`Step::Add`].
    pub fn new(brush: Brush, points: Vec<StrokePoint>) -> Stroke {
        Stroke {
            id: Version::EMPTY,
            name: String::new(),
            brush,
            action: Action::default(),
            area: Area::default(),
            is_hidden: false,
            eye: None,
            source: None,
            copy_of: CopyOf::default(),
            group: None,
            path: None,
            stencil: None,
            points,
        }
    }
}

/// A group of strokes, which can be shown, hidden and faded as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrokeGroup {
    /// Number that identifies the group within a list.
    pub number: u32,
    /// Name given by the artist.
    pub name: String,
    /// Opacity of the combined effect of its strokes, 0 to 1. If other strokes of the list are between its strokes, the
    /// parts are separate layers.
    pub opacity: f32,
    /// True if all its strokes are hidden.
    pub is_hidden: bool,
}

impl StrokeGroup {
    /// Returns the group with its opacity in range. NaN becomes 1.
    pub(crate) fn bounded(&self) -> StrokeGroup {
        let opacity = if self.opacity.is_finite() {
            self.opacity.clamp(0.0, 1.0)
        } else {
            1.0
        };
        StrokeGroup {
            opacity,
            ..self.clone()
        }
    }
}

/// Action of a brush.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// Lays paint.
    #[default]
    Paint,
    /// Takes paint away.
    Erase,
    /// Pulls paint along, like a finger.
    Smear,
    /// Softens paint.
    Blur,
    /// Makes the borders of paint harder.
    Sharpen,
    /// Copies paint from another place of the surface.
    Clone,
}

impl Action {
    /// All actions with their titles.
    pub const ALL: [(Action, &'static str); 6] = [
        (Action::Paint, "Paint"),
        (Action::Erase, "Erase"),
        (Action::Smear, "Smear"),
        (Action::Blur, "Blur"),
        (Action::Sharpen, "Sharpen"),
        (Action::Clone, "Clone"),
    ];

    /// Returns true if the action changes existing paint, so that its effect depends on that paint.
    pub fn adjusts(self) -> bool {
        matches!(self, Action::Smear | Action::Blur | Action::Sharpen | Action::Clone)
    }
}

/// Source of a stroke that copies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CopyOf {
    /// The paint below the stroke.
    #[default]
    Paint,
    /// The result that is connected to the node. A stroke without a source copies it in place.
    Input,
}

impl CopyOf {
    /// Both sources with their titles.
    pub const ALL: [(CopyOf, &'static str); 2] = [(CopyOf::Paint, "This paint"), (CopyOf::Input, "Another node")];

    pub(crate) fn is_paint(&self) -> bool {
        *self == CopyOf::Paint
    }
}

/// Area on which a stroke acts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Area {
    /// Along its way.
    #[default]
    Way,
    /// Everywhere.
    All,
    /// On all parts of the model that it touches.
    Part,
    /// On all connected pieces that it touches.
    Piece,
    /// On all texture charts that it touches.
    Chart,
    /// On all materials that it touches.
    Material,
    /// Everywhere, fading evenly from the first point to the last, along a straight line through space.
    Gradient,
    /// On the flat or gently curved side that it touches, up to edges between triangles that differ by more than the angle of the brush.
    Side,
    /// A single stamp at its first point, with full strength and without random differences, projected straight onto
    /// everything there that faces the same way.
    Decal,
    /// A single stamp like [`Area::Decal`] that follows the bends of the piece that it is on, like a label.
    Label,
    /// Inside of its way, as seen by the artist.
    Inside,
    /// On the connected area around its points with about the same amount of paint, also across seams.
    Similar,
    /// A band of stamps in a row along its way, bent with it, as wide as the brush.
    Ribbon,
}

impl Area {
    /// Returns true for areas that are a single stamp.
    pub fn is_single(self) -> bool {
        matches!(self, Area::Decal | Area::Label)
    }

    /// All areas with their titles.
    pub const ALL: [(Area, &'static str); 13] = [
        (Area::Way, "Stroke"),
        (Area::Ribbon, "Ribbon"),
        (Area::Decal, "Decal"),
        (Area::Label, "Label"),
        (Area::Inside, "Inside"),
        (Area::Similar, "Bucket"),
        (Area::Side, "Side"),
        (Area::Piece, "Piece"),
        (Area::Part, "Part"),
        (Area::Material, "Material"),
        (Area::Chart, "Chart"),
        (Area::All, "All"),
        (Area::Gradient, "Gradient"),
    ];
}

/// A point that a stroke passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePoint {
    /// Place on the surface.
    pub site: Site,
    /// Unit normal of the surface there. It helps to find the point again on a changed model.
    pub normal: [f32; 3],
    /// Content key of the triangle ([`crate::PaintSurface::triangle_key`]), by which the triangle is found again.
    pub triangle_key: u32,
    /// Pressure, 0 to 1.
    pub pressure: f32,
    /// True if no way leads here from the previous point: at the first point, and where the brush was lifted or jumped.
    pub starts: bool,
    /// Direction of the shaft of the pen there; `None` if it is unknown, for example for a mouse.
    pub shaft: Option<Shaft>,
}

impl StrokePoint {
    /// Returns how the pen touches the point.
    pub fn touch(&self) -> Touch {
        Touch {
            pressure: self.pressure,
            shaft: self.shaft,
        }
    }
}

/// A step from one list of strokes to the next.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Adds a stroke on top. Its id becomes the version that the step leads to; the given id is ignored.
    Add(Arc<Stroke>),
    /// Removes strokes.
    Remove(Vec<Version>),
    /// Changes a stroke's name, brush or visibility.
    Change {
        /// The stroke.
        stroke: Version,
        /// Its new name.
        name: String,
        /// Its new brush.
        brush: Box<Brush>,
        /// Whether it is hidden after the step.
        is_hidden: bool,
    },
    /// Moves a stroke to an index in the order; 0 is the lowest.
    Move {
        /// The stroke.
        stroke: Version,
        /// Its new index.
        to: usize,
    },
    /// Puts strokes into a group with a new name, opacity and visibility, or removes them from their groups.
    Group {
        /// The strokes.
        strokes: Vec<Version>,
        /// Their new group.
        group: Option<Arc<StrokeGroup>>,
    },
    /// Moves a stroke to other points.
    Place {
        /// The stroke.
        stroke: Version,
        /// Its new points.
        points: Vec<StrokePoint>,
        /// New bends of its path.
        path: Option<PathForm>,
        /// Eye of the artist for the new points.
        eye: Option<Eye>,
        /// Picture in front of the view through which it is now painted.
        stencil: Option<Arc<Stencil>>,
    },
}
