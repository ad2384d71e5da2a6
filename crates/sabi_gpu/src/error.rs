//! What can go wrong on a device, said to the person at it.

/// An error of the device or its memory; never a panic.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// There is no adapter at all.
    #[error(
        "no Vulkan, Metal or Direct3D 12 driver was found; on Debian or Ubuntu run `apt-get install mesa-vulkan-drivers \
         libvulkan1`, which works without a graphics card"
    )]
    NoAdapter,
    /// There are adapters, but not the one asked for.
    #[error("no adapter matches '{wanted}'; there are: {known}. Choose one with --adapter, or use --adapter auto")]
    NoSuchAdapter {
        /// As asked.
        wanted: String,
        /// Names of those there are.
        known: String,
    },
    /// The adapter lacks what every kernel needs.
    #[error("the adapter '{adapter}' cannot run Sabi: {why}. Choose another one with --adapter")]
    Unfit {
        /// Its name.
        adapter: String,
        /// What it lacks.
        why: String,
    },
    /// The device went away.
    #[error("the graphics device was lost ({0}); close other programs that use it, or choose --adapter cpu")]
    Lost(String),
    /// Textures would take more than the budget.
    #[error(
        "the textures need {needed_mib} MiB, more than the budget of {budget_mib} MiB; raise it with --budget, or bake \
         at a smaller size"
    )]
    OverBudget {
        /// Needed at once.
        needed_mib: u64,
        /// Allowed.
        budget_mib: u64,
    },
    /// The driver refused memory.
    #[error("the device is out of memory while making {what}; bake at a smaller size, or choose --adapter cpu")]
    OutOfMemory {
        /// What was to be made.
        what: String,
    },
    /// The model has more data than one buffer of this adapter holds.
    #[error(
        "the model is too large for the adapter: {what} takes {needed_mib} MiB and it can bind {limit_mib} MiB; reduce \
         the model's triangles, or choose another --adapter"
    )]
    TooLarge {
        /// Which data.
        what: &'static str,
        /// Needed.
        needed_mib: u64,
        /// The adapter's limit.
        limit_mib: u64,
    },
    /// The hierarchy of the model's triangles has too many levels for the kernel that follows rays.
    #[error(
        "rays cannot be followed on the device: the model's hierarchy has {depth} levels and the kernel takes 24; choose \
         --caster cpu"
    )]
    TooDeep {
        /// Its levels.
        depth: usize,
    },
    /// A kernel could not be made: a mistake in a node's text, in Sabi or in the driver.
    #[error(
        "the kernel of {nodes} cannot be compiled: {why}. If one of these nodes is your own, look there first; otherwise \
         bake with --no-fuse, or choose another --adapter"
    )]
    Kernel {
        /// The nodes in it.
        nodes: String,
        /// What was said against it, by Sabi or the driver.
        why: String,
    },
    /// Anything else the driver said.
    #[error("the graphics driver reported: {0}. Choose another --adapter if this stays")]
    Driver(String),
    /// The user stopped it.
    #[error("stopped")]
    Canceled,
    /// The result of a node that is no kernel could not be made.
    #[error("{why}")]
    Node {
        /// Its id.
        node: String,
        /// Why, as a sentence that names it.
        why: String,
    },
    /// A source could not be filled.
    #[error("{0}")]
    Source(String),
}
