//! Facts about a bake that failed.

use std::path::Path;

use schemars::JsonSchema;
use serde::Serialize;

/// Bake that failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
pub(crate) struct FailedBake {
    /// Version of Sabi.
    sabi: &'static str,
    /// Path of the graph as it was given.
    graph: String,
    /// The model.
    mesh: FailedMesh,
}

/// Model of a bake that failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, JsonSchema)]
struct FailedMesh {
    /// Path of the model as it was given.
    file: String,
}

impl FailedBake {
    /// Describes a bake with the facts that are known before it begins.
    pub(crate) fn new(graph: &Path, mesh: &Path) -> FailedBake {
        FailedBake {
            sabi: env!("CARGO_PKG_VERSION"),
            graph: graph.display().to_string(),
            mesh: FailedMesh {
                file: mesh.display().to_string(),
            },
        }
    }
}
