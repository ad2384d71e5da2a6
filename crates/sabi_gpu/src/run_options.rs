//! Options of a run.

use std::time::Duration;

use crate::rays::{CasterChoice, Hits};
use crate::shown_tiles::ShownTiles;
use crate::texture_budget::TextureBudget;

/// Default of [`RunOptions::keeps_from`].
pub const DEFAULT_KEEPS_FROM: Duration = Duration::from_millis(250);

/// Default of [`RunOptions::writes_over_from`]: two color textures of 2048². Below, the bands take more time than their memory is worth.
pub const DEFAULT_WRITES_OVER_FROM: u64 = 64 << 20;

/// Options of a run.
pub struct RunOptions<'a> {
    /// Longest time of one submission: about 25 ms where a window shares the queue, more in a bake.
    pub submission: Duration,
    /// Called between submissions; `true` cancels the run.
    pub is_canceled: &'a dyn Fn() -> bool,
    /// Called after each step with the number of steps done and of all steps.
    pub progress: &'a dyn Fn(usize, usize),
    /// Limit of the textures, those of the surface included; a cache has its own.
    pub budget: TextureBudget,
    /// Ray caster to use.
    pub caster: CasterChoice,
    /// Origin of ray hits.
    pub hits: Hits,
    /// True if the time of filling ghosts is measured, which costs a little time itself.
    pub times_ghosts: bool,
    /// True if kernels are forgotten after their last step: what a software driver compiles takes two megabytes each, and a run whose
    /// plan is the only one of a device needs none again.
    pub forgets_kernels: bool,
    /// Time of computing from which a small result is kept for later runs. A larger one takes longer to write and read, and is
    /// kept if its time is that much longer.
    pub keeps_from: Duration,
    /// Bytes of textures from which a kernel of points writes them, band by band, over those that it reads for the last time.
    pub writes_over_from: u64,
    /// Tiles whose results are shown; none if any texel may be read after the run. Where nothing else reads them, results are not
    /// computed in other tiles, which then hold anything.
    pub shown: Option<&'a ShownTiles>,
}

impl RunOptions<'_> {
    /// Options without cancellation and progress, with rays cast by [`CasterChoice::Auto`].
    pub fn new(submission: Duration, budget: TextureBudget) -> Self {
        RunOptions {
            submission,
            is_canceled: &|| false,
            progress: &|_, _| {},
            budget,
            caster: CasterChoice::Auto,
            hits: Hits::Cast,
            times_ghosts: false,
            forgets_kernels: false,
            keeps_from: DEFAULT_KEEPS_FROM,
            writes_over_from: DEFAULT_WRITES_OVER_FROM,
            shown: None,
        }
    }
}
