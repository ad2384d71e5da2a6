//! Results of nodes as tips of the brush, evaluated while the window goes on.

use std::sync::Arc;

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::{AdapterChoice, Gpu, Kinds, NodeRef, StampSquare, stamp_square};

use crate::task::Task;

/// Pixels along a side of the picture.
const SIDE: u32 = 512;

type Making = Task<Result<StampSquare, String>>;

/// The tip that is being made of a node's result, if any.
#[derive(Default)]
pub(crate) struct NodeTips {
    coming: Option<Making>,
    /// Those that are not wanted any more, until they end: dropping one waits for it.
    obsolete: Vec<Making>,
}

impl NodeTips {
    /// Starts to make a tip of a result; one that is still coming is not wanted any more.
    pub(crate) fn start(&mut self, context: &Context, gpu: &Arc<Gpu>, document: &OpenDocument, result: &NodeRef) {
        let graph = document.session.graph().clone();
        let kinds = Kinds::clone(&document.node_kinds().kinds);
        let adapter = AdapterChoice::Named(gpu.summary().name.clone());
        let gpu = gpu.clone();
        let node = match &result.port {
            Some(port) => format!("{}.{port}", result.node),
            None => result.node.clone(),
        };
        self.forget();
        self.coming = Some(Task::start(context, move || {
            stamp_square(&graph, kinds, gpu, adapter, &node, SIDE).map_err(|error| error.to_string())
        }));
    }

    /// Has no use any more for a tip that is coming, as when another graph is opened.
    pub(crate) fn forget(&mut self) {
        self.obsolete.extend(self.coming.take());
        self.obsolete.retain(|task| !task.is_over());
    }

    /// The picture of the tip once it is there, or why there is none.
    pub(crate) fn take(&mut self) -> Option<Result<StampSquare, String>> {
        let made = self.coming.as_ref()?.poll()?;
        self.coming = None;
        Some(made.unwrap_or_else(|_| Err("The picture of the node was not made: the evaluation broke off.".to_owned())))
    }
}
