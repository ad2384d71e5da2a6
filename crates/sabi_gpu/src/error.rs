//! Errors of a device, its memory and what runs on it.

/// Error of a device, its memory or a run on it. Its text says what is the case; what helps follows from the variant and is
/// said by the callers, which know what can be chosen.
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
    /// A result that was kept by an earlier run is gone or damaged; the run begins again without it.
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
    /// The textures of a run exceed what is left of the memory of the process, which they are in.
    #[error(
        "the textures need {needed_mib} MiB, which this driver takes from the memory of the process; {left_mib} MiB of it are left"
    )]
    OverMemory {
        /// Peak size of all textures, MiB.
        needed_mib: u64,
        /// Memory that the model leaves, MiB.
        left_mib: u64,
    },
    /// The driver refused to allocate memory.
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
    /// A kernel could not be compiled: a defect of a node's text, of Sabi or of the driver.
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
    /// A submission did not end.
    #[error(
        "the device was busy with {} for more than {seconds} seconds, and the run was stopped",
        of(nodes)
    )]
    TooLong {
        /// Ids of the nodes that were evaluated; none for work of Sabi's own.
        nodes: Vec<String>,
        /// Time after which it was given up.
        seconds: u64,
    },
    /// The user canceled the run.
    #[error("stopped")]
    Canceled,
    /// A source node could not give its result.
    #[error("{reason}")]
    Node {
        /// Id of the node.
        node: String,
        /// Sentence that names the node.
        reason: String,
    },
    /// The scene that rays are cast into could not be made.
    #[error("{0}")]
    Scene(String),
    /// Something that the callers of this crate must not ask for.
    #[error("{0}; this is a defect of Sabi")]
    Defect(String),
}

impl GpuError {
    /// This error with the nodes that were evaluated, where it is one of them and does not name them yet.
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
