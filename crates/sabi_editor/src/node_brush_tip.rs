//! Results of nodes as tips of the brush, evaluated in the background.

use std::sync::Arc;

use egui::Context;
use sabi_editing::OpenDocument;
use sabi_engine::Kinds;
use sabi_engine::rendering::{StampSquare, stamp_square};
use sabi_gpu::{AdapterChoice, Gpu};
use sabi_graph::NodeRef;

use crate::task::Task;

/// Pixels along a side of the picture.
const SIDE: u32 = 512;

type TipTask = Task<Result<StampSquare, String>>;

/// The tip that is being made of a node's result, if any.
#[derive(Default)]
pub(crate) struct NodeBrushTip {
    coming: Option<TipTask>,
    /// Discarded tips that are still being made: dropping one would wait for it.
    obsolete: Vec<TipTask>,
}

impl NodeBrushTip {
    /// Starts to make a tip of a result, in place of one that is still being made.
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

    /// Discards a tip that is being made, as when another graph is opened.
    pub(crate) fn forget(&mut self) {
        self.obsolete.extend(self.coming.take());
        self.obsolete.retain(|task| !task.is_over());
    }

    /// Returns the picture of the tip, or the reason that there is none, once it is made.
    pub(crate) fn take(&mut self) -> Option<Result<StampSquare, String>> {
        let made = self.coming.as_ref()?.poll()?;
        self.coming = None;
        Some(made.unwrap_or_else(|_| Err("The picture of the node was not made: the evaluation broke off.".to_owned())))
    }
}
