//! Resources of a plan: contents of textures before they are assigned slots, and the steps that read and write them.

use sabi_nodes::link::Plane;

use crate::fuse::ResultRef;
use crate::level::Level;
use crate::plan::{SlotExtent, Step};

/// Content of a texture on a level of the surface, before it is assigned a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Resource {
    pub(crate) content: TextureContent,
    pub(crate) level: Level,
}

impl Resource {
    /// A result, which is on the finest level.
    pub(crate) fn result(value: ResultRef) -> Resource {
        Resource {
            content: TextureContent::Result(value),
            level: Level::FINEST,
        }
    }

    /// Size of its slot.
    pub(crate) fn extent(self) -> SlotExtent {
        match self.content {
            TextureContent::Survey(_, false) => SlotExtent::Survey,
            TextureContent::Survey(_, true) => SlotExtent::GroupSurvey,
            TextureContent::SurveyPass(_, _, false) => SlotExtent::Single,
            TextureContent::SurveyPass(_, _, true) => SlotExtent::Groups,
            TextureContent::Result(_)
            | TextureContent::Pass(..)
            | TextureContent::Normals(_)
            | TextureContent::Scratch(..)
            | TextureContent::Converted(..) => SlotExtent::Level(self.level),
        }
    }
}

/// Content of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum TextureContent {
    Result(ResultRef),
    /// Result of a pass of a field, or mean of a pass over rays: node and pass.
    Pass(usize, usize),
    /// Normals, for a node whose means over rays are denoised.
    Normals(usize),
    /// Second texture of a repeated function, used alternately with its result: node and index of the step.
    Scratch(usize, usize),
    /// Table of a node's survey, and whether it has one for each group.
    Survey(usize, bool),
    /// Value of a pass for the whole surface or for each group: node, pass, and whether there are groups.
    SurveyPass(usize, usize, bool),
    /// Converted value that an input of a field or a survey reads: node and index of the input.
    Converted(usize, usize),
}

/// Step whose slots are not assigned yet.
pub(crate) struct UnassignedStep {
    /// The step with empty or zero slots.
    pub(crate) step: Step,
    pub(crate) reads: Vec<Option<(Resource, Plane)>>,
    pub(crate) writes: Vec<Option<(Resource, Plane)>>,
    /// Second texture of a repeated function.
    pub(crate) scratch: Option<(Resource, Plane)>,
}
