//! Options of a run.

use std::time::Duration;

use crate::rays::{CasterChoice, Hits};
use crate::shown_tiles::ShownTiles;
use crate::texture_budget::TextureBudget;

/// Default of [`RunOptions::keeps_from`].
pub const DEFAULT_KEEPS_FROM: Duration = Duration::from_millis(250);

/// Default of [`RunOptions::writes_over_from`]: two color textures of 2048². For less, the bands cost more time than the
/// saved memory is worth.
pub const DEFAULT_WRITES_OVER_FROM: u64 = 64 << 20;

/// Options of a run.
pub struct RunOptions<'a> {
    /// Maximum time of one submission: about 25 ms if a window shares the queue, more in a bake.
    pub submission: Duration,
    /// Called between submissions; `true` cancels the run.
    pub is_canceled: &'a dyn Fn() -> bool,
    /// Called after each step with the number of finished steps and the number of all steps.
    pub progress: &'a dyn Fn(usize, usize),
    /// Limit of the textures, including those of the surface. A cache has its own limit.
    pub budget: TextureBudget,
    /// Ray caster to use.
    pub caster: CasterChoice,
    /// Origin of ray hits.
    pub hits: Hits,
    /// True if the time for filling ghosts is measured, which itself takes a little time.
    pub times_ghosts: bool,
    /// True if kernels are forgotten after their last step. A kernel that a software driver compiled takes two megabytes,
    /// and if a device runs only one plan, no kernel is needed again.
    pub forgets_kernels: bool,
    /// Computing time from which a small result is kept for later runs. A larger result takes longer to write and read, and
    /// is kept only if its computing time is longer in proportion.
    pub keeps_from: Duration,
    /// Number of bytes of textures from which a kernel of points writes its results, band by band, over inputs that it is
    /// the last to read.
    pub writes_over_from: u64,
    /// Tiles whose results are shown; `None` if any texel may be read after the run. Results that nothing else reads are
    /// not computed in other tiles, where their content is undefined.
    pub shown: Option<&'a ShownTiles>,
}

impl RunOptions<'_> {
    /// Creates options without cancellation and progress, and with [`CasterChoice::Auto`].
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
