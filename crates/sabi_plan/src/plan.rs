//! The plan: passes as plain data, and as text.

use std::fmt;

use sabi_nodes::kind::Finds;
use sabi_nodes::link::{Domain, Format, KernelSpec, Plane, StoredLayout};

use crate::level::Level;
use crate::source_values::SourceValues;

/// Steps that give the wanted results.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Plan {
    /// Textures of results; several results may share one at different times.
    pub slots: Vec<Slot>,
    /// Steps in order.
    pub steps: Vec<Step>,
    /// The wanted results, in the order of the targets that could be planned.
    pub results: Vec<PlannedResult>,
    /// Ids of all planned nodes, in evaluation order.
    pub nodes: Vec<String>,
}

/// A texture of the pool.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Its format.
    pub format: Format,
    /// Its size.
    pub extent: SlotExtent,
}

/// Size of a slot.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum SlotExtent {
    /// Size of a level of the surface.
    Level(Level),
    /// The table of a survey.
    Survey,
    /// The tables of a survey's groups.
    GroupSurvey,
    /// One value for the whole surface.
    Single,
    /// A value for each group of a survey.
    Groups,
}

/// Index into [`Plan::slots`].
pub type SlotRef = usize;

/// A step of a plan.
#[derive(Clone, Debug, PartialEq)]
pub enum Step {
    /// Slots filled by the engine.
    Source(SourceStep),
    /// A kernel that runs over the surface.
    Kernel(KernelStep),
    /// A move of a stored plane to another level.
    Move(MoveStep),
    /// A survey of a stored mask over the whole surface.
    Survey(SurveyStep),
}

/// A survey: how much of the surface, by its true area, has which value of a mask.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurveyStep {
    /// Id of the node that reads the survey.
    pub node: String,
    /// Which places are measured together.
    pub each: Grouping,
    /// Slot of the mask, on the finest level.
    pub from: SlotRef,
    /// Slot of the table, see `lib/survey.wgsl`.
    pub to: SlotRef,
}

/// Places that a survey measures together: the whole surface, or the places of a group.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Grouping {
    /// All of the surface.
    #[default]
    Whole,
    /// The places of each part.
    Part,
    /// The places of each piece.
    Piece,
    /// The places of each chart.
    Chart,
}

impl Grouping {
    /// Returns the grouping for a choice, given its index in `SURVEY_GROUPINGS` of `sabi_nodes`.
    pub(crate) fn of_choice(number: u32) -> Grouping {
        match number {
            1 => Grouping::Part,
            2 => Grouping::Piece,
            3 => Grouping::Chart,
            _ => Grouping::Whole,
        }
    }
}

/// Move of a plane from one level of the surface to another.
///
/// Coarser texels get the mean of the finer texels of their chart that they cover; finer texels are interpolated within the
/// chart. Ghosts are filled afterwards. If the other level has no texel near, all components are 0. Points get the mean of
/// their cells, and texels are interpolated between the points around them.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MoveStep {
    /// Id of the first node that reads the plane on the new level.
    pub node: String,
    /// Slot that is read.
    pub from: SlotRef,
    /// Slot that is written.
    pub to: SlotRef,
    /// Format of both.
    pub format: Format,
    /// Levels of both.
    pub levels: [Level; 2],
    /// Key and plane of the result that it brings to the finest level.
    pub result: Option<([u8; 32], Plane)>,
}

/// Results made without a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct SourceStep {
    /// Index of the node in the flat graph.
    pub node: usize,
    /// Its id.
    pub id: String,
    /// Its kind.
    pub kind: String,
    /// Its parameters.
    pub values: SourceValues,
    /// Slots of its inputs, in the order of the kind; `None` for inputs that are not connected.
    pub reads: Vec<Option<SlotRef>>,
    /// Results that are read: name, planes and slots.
    pub writes: Vec<(String, Vec<(Plane, SlotRef)>)>,
    /// Key of each of `writes`.
    pub keys: Vec<[u8; 32]>,
}

/// A kernel over all covered tiles.
#[derive(Clone, Debug, PartialEq)]
pub struct KernelStep {
    /// The kernel.
    pub spec: KernelSpec,
    /// Parameter bytes and knobs, one for each block of the spec.
    pub blocks: Vec<BlockValues>,
    /// Flag words of an interactive kernel; see `sabi_nodes::link`.
    pub flags: [u32; 4],
    /// Slots of the spec's loads, plane by plane; `None` for unbound planes of an interactive kernel.
    pub reads: Vec<Option<SlotRef>>,
    /// Slots of the spec's stores, plane by plane; `None` for channels that an interactive kernel does not set.
    pub writes: Vec<Option<SlotRef>>,
    /// True if ghosts are filled across their links afterwards. Set for fields, whose kernels skip ghosts.
    pub fills_ghosts: bool,
    /// Repetition, in which each run reads the result of the one before.
    pub feedback: Option<Feedback>,
    /// Rays of a kernel whose results are means over them.
    pub rays: Option<Box<StepRays>>,
    /// Level of the surface that it runs on and that all its slots are on.
    pub level: Level,
    /// Ids of the nodes in it, in order; empty for a conversion and for normals.
    pub nodes: Vec<String>,
    /// Share of the kernel's cost for each of `nodes`; they add up to 1.
    pub cost_shares: Vec<f32>,
    /// Keys of the stored results.
    pub keys: Vec<[u8; 32]>,
}

/// The rays of a kernel.
#[derive(Clone, Debug, PartialEq)]
pub struct StepRays {
    /// Rays of each texel.
    pub count: u32,
    /// Hit that each ray looks for.
    pub finds: Finds,
    /// Key of the hits of the longest rays, which does not depend on other parameters; `None` if rays depend on inputs.
    pub key: Option<[u8; 32]>,
    /// Parameter that limits their length.
    pub reach: Option<Reach>,
    /// Minimum angle, in radians, between the triangle on which a ray starts and the triangle that it hits. At smaller
    /// angles a hit is ignored.
    pub least_turn: Option<f32>,
    /// Keys of the node's results that are computed from the hits of these rays, in this step or in later ones.
    pub results: Vec<[u8; 32]>,
}

/// Parameter that limits the length of rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// Its offset in the bytes of `struct Params`.
    pub offset: usize,
    /// Largest value of its slider, or its present value if that is larger; working units.
    pub longest: f32,
}

/// Repetition of a field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Feedback {
    /// Number of runs, at least 1.
    pub run_count: u32,
    /// Index into [`KernelStep::reads`] of the texture that is replaced by the previous result from the second run on.
    pub read: usize,
    /// Slot used alternately with the slot of the result.
    pub scratch: SlotRef,
}

/// Values of one parameter block.
#[derive(Clone, Debug, PartialEq)]
pub struct BlockValues {
    /// Bytes of `struct Params`.
    pub params: Vec<u8>,
    /// Knob values by input; `None` for an input without a knob.
    pub knobs: Vec<Option<Vec<f32>>>,
}

/// A wanted result.
#[derive(Clone, Debug, PartialEq)]
pub struct PlannedResult {
    /// The target.
    pub target: crate::Target,
    /// Its origin: node id and result.
    pub from: (String, String),
    /// Its type and channels in storage.
    pub stored: StoredLayout,
    /// Slots, one for each plane.
    pub slots: Vec<SlotRef>,
    /// Its key.
    pub key: [u8; 32],
}

impl KernelStep {
    /// Returns true if each texel depends on the same texel of what is read alone.
    pub fn is_of_points(&self) -> bool {
        self.spec.domain == Domain::AllTexels
            && self.level == Level::FINEST
            && self.feedback.is_none()
            && self.rays.is_none()
            && !self.fills_ghosts
    }
}

impl Plan {
    /// Number of kernel steps.
    pub fn passes(&self) -> usize {
        self.steps.iter().filter(|step| matches!(step, Step::Kernel(_))).count()
    }

    /// Groups of nodes that share a kernel.
    pub fn fused(&self) -> Vec<Vec<String>> {
        let kernels = self.steps.iter().filter_map(|step| match step {
            Step::Kernel(kernel) if kernel.nodes.len() > 1 => Some(kernel.nodes.clone()),
            _ => None,
        });
        kernels.collect()
    }
}

impl fmt::Display for Plan {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for step in &self.steps {
            match step {
                Step::Source(source) => {
                    write!(f, "source {} {}", source.id, source.kind)?;
                    write_slots(f, " <-", source.reads.iter().copied())?;
                    let slots = source
                        .writes
                        .iter()
                        .flat_map(|(_, planes)| planes)
                        .map(|(_, slot)| Some(*slot));
                    write_slots(f, " ->", slots)?;
                }
                Step::Kernel(kernel) => write_kernel(f, kernel)?,
                Step::Survey(step) => {
                    write!(f, "survey {} <- s{} -> s{}", step.node, step.from, step.to)?;
                    f.write_str(match step.each {
                        Grouping::Whole => "",
                        Grouping::Part => " each part",
                        Grouping::Piece => " each piece",
                        Grouping::Chart => " each chart",
                    })?;
                }
                Step::Move(step) => {
                    let [from, to] = step.levels;
                    write!(f, "move s{} -> s{} level {from} -> {to}", step.from, step.to)?;
                }
            }
            writeln!(f)?;
        }
        for result in &self.results {
            write!(f, "result {}", result.stored.ty)?;
            write_slots(f, "", result.slots.iter().map(|slot| Some(*slot)))?;
            writeln!(f)?;
        }
        Ok(())
    }
}

fn write_kernel(f: &mut fmt::Formatter<'_>, kernel: &KernelStep) -> fmt::Result {
    match kernel.nodes.as_slice() {
        [] if kernel.reads.is_empty() => f.write_str("normals")?,
        [] => f.write_str("convert")?,
        nodes => write!(f, "pass {}", nodes.join(" "))?,
    }
    write_slots(f, " <-", kernel.reads.iter().copied())?;
    write_slots(f, " ->", kernel.writes.iter().copied())?;
    if let Some(feedback) = &kernel.feedback {
        write!(f, " x{} via s{}", feedback.run_count, feedback.scratch)?;
    }
    match kernel.spec.domain {
        Domain::Once => f.write_str(" once")?,
        Domain::Groups => f.write_str(" for each group")?,
        Domain::AllTexels | Domain::OwnedTexels | Domain::OwnedTexelsByRays => {}
    }
    if kernel.level != Level::FINEST {
        write!(f, " level {}", kernel.level)?;
    }
    if let Some(rays) = &kernel.rays {
        write!(f, " {} rays", rays.count)?;
    }
    if kernel.fills_ghosts {
        f.write_str(" halo")?;
    }
    Ok(())
}

fn write_slots(f: &mut fmt::Formatter<'_>, arrow: &str, slots: impl Iterator<Item = Option<SlotRef>>) -> fmt::Result {
    let slots: Vec<SlotRef> = slots.flatten().collect();
    if !slots.is_empty() {
        f.write_str(arrow)?;
    }
    for slot in slots {
        write!(f, " s{slot}")?;
    }
    Ok(())
}
