//! How a long piece of work tells where it is, and how it is stopped.

/// A part of a bake.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stage {
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

impl Stage {
    /// A word for progress bars.
    pub fn label(self) -> &'static str {
        match self {
            Stage::Load => "Reading",
            Stage::Atlas => "Linking the atlas",
            Stage::Run => "Evaluating",
            Stage::Encode => "Writing maps",
            Stage::Draw => "Drawing",
        }
    }
}

/// Listens to a piece of work, and may stop it.
pub trait Progress: Sync {
    /// So many of so many steps of a stage are done.
    fn advance(&self, stage: Stage, done: usize, of: usize);
    /// Asked between steps; `true` ends the work with an error of kind `Interrupted`.
    fn is_canceled(&self) -> bool;
}

/// Listens to nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Silent;

impl Progress for Silent {
    fn advance(&self, _stage: Stage, _done: usize, _of: usize) {}

    fn is_canceled(&self) -> bool {
        false
    }
}
