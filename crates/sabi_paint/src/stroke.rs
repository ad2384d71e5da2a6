//! Strokes, and the steps from one list of strokes to the next.

use std::sync::Arc;

use sabi_surface::patch::Site;
use serde::{Deserialize, Serialize};

use crate::brush::Brush;
use crate::limits::Eye;
use crate::path_form::PathForm;
use crate::pen::{Shaft, Touch};
use crate::picture::PictureName;
use crate::stencil::Stencil;
use crate::version::Version;

/// One stroke of a brush.
#[derive(Clone, Debug, PartialEq)]
pub struct Stroke {
    /// Identity, which stays when the stroke is changed: the version in which it was made.
    pub id: Version,
    /// Name given by the artist; empty for none.
    pub name: String,
    /// The brush.
    pub brush: Brush,
    /// Action of the brush.
    pub action: Action,
    /// Where it does that.
    pub area: Area,
    /// Hidden strokes leave nothing.
    pub is_hidden: bool,
    /// Eye of the artist while it was drawn; none in the 2D view.
    pub eye: Option<Eye>,
    /// Place from which [`Action::Clone`] copies to the first point.
    pub source: Option<StrokePoint>,
    /// Source of [`Action::Clone`] there.
    pub copy_of: CopyOf,
    /// The group that it belongs to.
    pub group: Option<Arc<StrokeGroup>>,
    /// Bends of the path that it follows; none where its way was drawn by hand.
    pub path: Option<PathForm>,
    /// Picture before the view that it was painted through.
    pub stencil: Option<Arc<Stencil>>,
    /// Where it passes, in order; for a path its knots and handles ([`Stroke::as_path`]).
    pub points: Vec<StrokePoint>,
}

impl Stroke {
    /// True if what it leaves depends on the paint below it.
    pub fn depends_on_paint(&self) -> bool {
        self.changes_paint() || self.area == Area::Similar
    }

    /// True if it changes or copies what is on the canvas, or copies from elsewhere: what lies at each place itself is laid as a color is.
    pub(crate) fn changes_paint(&self) -> bool {
        self.action.adjusts() && !self.copies_in_place()
    }

    /// True if it copies what the result that is connected to the node has at each place itself.
    pub(crate) fn copies_in_place(&self) -> bool {
        self.copies_input() && self.source.is_none()
    }

    /// True if it copies the result that is connected to the node.
    pub fn copies_input(&self) -> bool {
        self.action == Action::Clone && self.copy_of == CopyOf::Input
    }

    /// True if it leaves nothing, since it or its group is hidden.
    pub fn leaves_nothing(&self) -> bool {
        self.is_hidden || self.group.as_ref().is_some_and(|group| group.is_hidden)
    }

    /// Pictures that it needs: that of its brush, and that of its stencil.
    pub fn pictures(&self) -> impl Iterator<Item = &PictureName> {
        let of_stencil = self.stencil.as_ref().map(|stencil| &stencil.picture);
        let tips = self.brush.picture.iter().chain(of_stencil);
        tips.map(|tip| &tip.picture)
    }

    /// A stroke that lays paint along its way, without a name. Its id is given to it by [`Step::Add`].
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

/// A group of strokes, which is shown and hidden and made fainter as a whole.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct StrokeGroup {
    /// Number by which its strokes know it, its own among the groups of a list.
    pub number: u32,
    /// Name given by the artist.
    pub name: String,
    /// Share, 0 to 1, of what its strokes leave together that is seen. Strokes of it that do not lie on each other in the list are layers
    /// of their own.
    pub opacity: f32,
    /// True if all its strokes are hidden.
    pub is_hidden: bool,
}

impl StrokeGroup {
    /// The group with its opacity in range; 1 where it is no number.
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

/// What a brush does.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Action {
    /// Lays paint.
    #[default]
    Paint,
    /// Takes paint away.
    Erase,
    /// Pulls paint along, as a finger does.
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

    /// Returns true if the action changes paint that is there, so that what it leaves depends on it.
    pub fn adjusts(self) -> bool {
        matches!(self, Action::Smear | Action::Blur | Action::Sharpen | Action::Clone)
    }
}

/// Source of a stroke that copies.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CopyOf {
    /// The paint below it.
    #[default]
    Paint,
    /// The result that is connected to the node. A stroke without a source copies what lies at each place itself.
    Input,
}

impl CopyOf {
    /// Both with their titles.
    pub const ALL: [(CopyOf, &'static str); 2] = [(CopyOf::Paint, "This paint"), (CopyOf::Input, "Another node")];

    pub(crate) fn is_paint(&self) -> bool {
        *self == CopyOf::Paint
    }
}

/// Where a stroke acts.
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
    /// Everywhere, fading evenly from the first place to the last, straight through space.
    Gradient,
    /// On the flat or softly bent side that it touches: up to edges between triangles that differ by more than the angle of the
    /// brush.
    Side,
    /// A single stamp at its first place, in full and without random differences, thrown straight onto everything there that faces
    /// the same way.
    Decal,
    /// A single stamp as [`Area::Decal`], which follows the bends of the piece that it is on, as a label does.
    Label,
    /// Inside of its way, as the artist saw it.
    Inside,
    /// On the connected area around its places that is painted about as much as they are, over seams, too.
    Similar,
    /// A band of stamps laid end to end along its way and bent with it, as wide as the brush.
    Ribbon,
}

impl Area {
    /// True for areas that are a single stamp.
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

/// A place that a stroke passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StrokePoint {
    /// Place on the surface.
    pub site: Site,
    /// Unit normal of the surface there, by which the place is found again on a changed model.
    pub normal: [f32; 3],
    /// Content of the triangle ([`crate::PaintSurface::triangle_key`]), by which it is found again.
    pub triangle_key: u32,
    /// Pressure, 0 to 1.
    pub pressure: f32,
    /// True where no way leads here from the point before: the first point, and where the brush was lifted or jumped.
    pub starts: bool,
    /// Direction of the shaft of the pen there; none where it is not known, as for a mouse.
    pub shaft: Option<Shaft>,
}

impl StrokePoint {
    /// Way in which the pen touches the place.
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
    /// Adds a stroke on top. Its id is the version that the step leads to, whatever it says.
    Add(Arc<Stroke>),
    /// Removes strokes.
    Remove(Vec<Version>),
    /// Changes a stroke's name, brush or visibility.
    Change {
        /// The stroke.
        stroke: Version,
        /// Its name from now on.
        name: String,
        /// Its brush from now on.
        brush: Box<Brush>,
        /// Whether it is hidden from now on.
        is_hidden: bool,
    },
    /// Moves a stroke to a place in the order, 0 the lowest.
    Move {
        /// The stroke.
        stroke: Version,
        /// Its index from now on.
        to: usize,
    },
    /// Puts strokes into a group, with its name, opacity and visibility from now on, or takes them out of theirs.
    Group {
        /// The strokes.
        strokes: Vec<Version>,
        /// Their group from now on.
        group: Option<Arc<StrokeGroup>>,
    },
    /// Lays a stroke to other places.
    Place {
        /// The stroke.
        stroke: Version,
        /// Its places from now on.
        points: Vec<StrokePoint>,
        /// Bends of its path from now on.
        path: Option<PathForm>,
        /// Eye of the artist then.
        eye: Option<Eye>,
        /// Picture before the view that it is painted through from now on.
        stencil: Option<Arc<Stencil>>,
    },
}
