//! Node kinds of the open document. Reading their files takes time, so callers do it where nothing waits for it.

use std::sync::Arc;

use sabi_engine::Kinds;
use sabi_engine::catalog::Catalog;

/// Node kinds of a document, as they were last read.
#[derive(Clone)]
pub struct NodeKinds {
    /// The kinds.
    pub kinds: Arc<Kinds>,
    /// Descriptions of all kinds.
    pub catalog: Arc<Catalog>,
    /// Number that increases each time they are read again.
    pub revision: u64,
}

impl NodeKinds {
    /// Describes kinds that were read.
    pub(crate) fn new(kinds: Kinds, revision: u64) -> NodeKinds {
        NodeKinds {
            catalog: Arc::new(Catalog::new(&kinds)),
            kinds: Arc::new(kinds),
            revision,
        }
    }
}
