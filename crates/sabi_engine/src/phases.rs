//! How a long piece of work tells where it is, and how it is stopped.

/// A part of a bake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Phase {
    /// Reading the graph and the model.
    Load,
    /// Building the linked atlas.
    Atlas,
    /// Running the plan.
    Run,
    /// Encoding and writing the maps.
    Encode,
    /// Drawing pictures.
    Draw,
}

impl Phase {
    /// A word for progress bars.
    pub fn label(self) -> &'static str {
        match self {
            Phase::Load => "Reading",
            Phase::Atlas => "Linking the atlas",
            Phase::Run => "Evaluating",
            Phase::Encode => "Writing maps",
            Phase::Draw => "Drawing",
        }
    }
}

/// Listens to a piece of work, and may stop it.
pub trait Progress: Sync {
    /// So many of so many steps of a stage are done.
    fn advance(&self, stage: Phase, done: usize, of: usize);
    /// Asked between steps; `true` ends the work with an error of kind `Interrupted`.
    fn is_canceled(&self) -> bool;
}

/// Listens to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoProgress;

impl Progress for NoProgress {
    fn advance(&self, _stage: Phase, _done: usize, _of: usize) {}

    fn is_canceled(&self) -> bool {
        false
    }
}
