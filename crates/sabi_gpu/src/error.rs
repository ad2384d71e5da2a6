//! Errors of a device, its memory and what runs on it.

/// Error of a device, its memory or a run on it. Its text describes the problem. Remedies follow from the variant and are
/// added by the callers, which know what the user can choose.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// No adapter was found.
    #[error(
        "no Vulkan, Metal or Direct3D 12 driver was found; on Debian or Ubuntu run `apt-get install mesa-vulkan-drivers \
         libvulkan1`, which works without a graphics card"
    )]
    NoAdapter,
    /// Adapters were found, but not the requested one.
    #[error("no adapter matches '{wanted}'; there are: {known}")]
    NoSuchAdapter {
        /// Requested name.
        wanted: String,
        /// Names of the adapters found.
        known: String,
    },
    /// The adapter lacks a limit or feature that every kernel needs.
    #[error("the adapter '{adapter}' cannot run Sabi: {reason}")]
    Unsuitable {
        /// Name of the adapter.
        adapter: String,
        /// Missing limit or feature.
        reason: String,
    },
    /// The device was lost, for the reason that the driver gives.
    #[error("the graphics device was lost ({0})")]
    Lost(String),
    /// A result that an earlier run kept is missing or damaged. The run starts again without it.
    #[error("a result that was kept by an earlier run is gone")]
    ResultGone,
    /// The textures of a run exceed the budget.
    #[error("the textures need {needed_mib} MiB, more than the budget of {budget_mib} MiB")]
    OverBudget {
        /// Peak size of all textures, MiB.
        needed_mib: u64,
        /// Budget, MiB.
        budget_mib: u64,
    },
    /// The textures of a run exceed the memory that is left to the process, in which the driver keeps them.
    #[error(
        "the textures need {needed_mib} MiB, which this driver takes from the memory of the process; {left_mib} MiB of it are left"
    )]
    OverMemory {
        /// Peak size of all textures, MiB.
        needed_mib: u64,
        /// Memory that the model leaves, MiB.
        left_mib: u64,
    },
    /// The driver could not allocate memory.
    #[error("the device is out of memory while making {what}")]
    OutOfMemory {
        /// Resource that was being created.
        what: String,
    },
    /// The model has more data than one buffer of this adapter holds.
    #[error("the model is too large for the adapter: {what} takes {needed_mib} MiB and it can bind {limit_mib} MiB")]
    TooLarge {
        /// Data that is too large.
        what: &'static str,
        /// Size of the data, MiB.
        needed_mib: u64,
        /// Limit of the adapter, MiB.
        limit_mib: u64,
    },
    /// The ray hierarchy of the model has more levels than the traversal kernel's stack.
    #[error(
        "rays cannot be followed on the device: the model's hierarchy has {depth} levels and the kernel takes {limit}"
    )]
    TooDeep {
        /// Levels of the hierarchy.
        depth: usize,
        /// Levels that the kernel takes.
        limit: usize,
    },
    /// A kernel could not be compiled. The cause is a mistake in a node's code, in Sabi or in the driver.
    #[error("the kernel of {nodes} cannot be compiled: {reason}. If one of these nodes is your own, look there first")]
    Kernel {
        /// Ids of the nodes fused into it.
        nodes: String,
        /// Message of the linker or the driver.
        reason: String,
    },
    /// Any other error that the driver reported.
    #[error("the graphics driver reported: {0}")]
    Driver(String),
    /// The device did not finish a submission in time.
    #[error(
        "the device was busy with {} for more than {seconds} seconds, and the run was stopped",
        of(nodes)
    )]
    TooLong {
        /// Ids of the nodes that were evaluated; empty for kernels that belong to no node.
        nodes: Vec<String>,
        /// Time after which the run was stopped, in seconds.
        seconds: u64,
    },
    /// The user canceled the run.
    #[error("stopped")]
    Canceled,
    /// A source node could not provide its result.
    #[error("{reason}")]
    Node {
        /// Id of the node.
        node: String,
        /// Sentence that names the node.
        reason: String,
    },
    /// The scene for rays could not be built.
    #[error("{0}")]
    Scene(String),
    /// The caller requested something that this crate does not allow.
    #[error("{0}; this is a defect of Sabi")]
    Defect(String),
}

impl GpuError {
    /// Adds the ids of the evaluated nodes to an error that has a place for them and does not name any yet.
    pub(crate) fn of_nodes(mut self, evaluated: &[String]) -> GpuError {
        if let GpuError::TooLong { nodes, .. } = &mut self
            && nodes.is_empty()
        {
            nodes.extend_from_slice(evaluated);
        }
        self
    }
}

fn of(nodes: &[String]) -> String {
    match nodes {
        [] => "one step".to_owned(),
        [node] => format!("node '{node}'"),
        _ => {
            let quoted: Vec<String> = nodes.iter().map(|node| format!("'{node}'")).collect();
            format!("the nodes {}", quoted.join(", "))
        }
    }
}
