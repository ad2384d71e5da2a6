//! State of a function that is analyzed.

use naga::{Function, Handle, LocalVariable};

use super::writes::Writes;
use crate::analysis::walk::{Calls, Store};

/// State of a function during one call of it.
pub(super) struct WriteFrame<'m> {
    pub(super) function: &'m Function,
    /// Writes for each argument; used only for arguments that are materials.
    pub(super) arguments: Vec<Writes>,
    pub(super) stores: Vec<Store>,
    pub(super) calls: Calls,
    /// Variables that are being analyzed.
    pub(super) open: Vec<Handle<LocalVariable>>,
}
