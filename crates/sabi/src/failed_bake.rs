//! Facts about a bake that failed.

use std::path::Path;

use serde::Serialize;

/// Bake that failed.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub(crate) struct FailedBake {
    sabi: &'static str,
    graph: String,
    mesh: FailedMesh,
}

#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
struct FailedMesh {
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
