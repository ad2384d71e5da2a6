//! Nodes that targets need, in evaluation order.

use sabi_graph::FlatRef;

use crate::muting::unmuted_origin;
use crate::request::{Planner, Target};

impl Planner<'_> {
    /// Origin of a target: the node itself, or what it passes on while it is muted.
    pub(crate) fn target_origin(&self, target: &Target) -> Option<FlatRef> {
        let from = FlatRef {
            node: target.node,
            port: target.port.clone(),
        };
        unmuted_origin(self.graph, self, &from).0
    }

    /// Returns the nodes that the targets need, inputs before readers, depth first so that chains stay together. Muted
    /// nodes on the way are included, so that their problems are reported.
    pub(crate) fn evaluation_order(&self, targets: &[Target]) -> Vec<usize> {
        let mut seen = vec![false; self.graph.nodes.len()];
        let mut order = Vec::new();
        for target in targets {
            let from = FlatRef {
                node: target.node,
                port: target.port.clone(),
            };
            // An explicit stack is used, since graphs may be deeper than the stack of a thread allows. It is not petgraph's
            // `DfsPostOrder`: links are followed through muted nodes, which are listed on the way.
            let mut stack = Vec::new();
            self.follow(&from, &mut seen, &mut order, &mut stack);
            while let Some((node, inputs_done)) = stack.pop() {
                if inputs_done {
                    order.push(node);
                } else if !std::mem::replace(&mut seen[node], true) {
                    stack.push((node, true));
                    let mut fresh = Vec::new();
                    for from in self.graph.nodes[node].inputs.values() {
                        self.follow(from, &mut seen, &mut order, &mut fresh);
                    }
                    stack.extend(fresh.into_iter().rev());
                }
            }
        }
        order
    }

    /// Adds the origin of a link to `next`. Muted nodes on the way are added to `order` directly, since they need no other node.
    fn follow(&self, from: &FlatRef, seen: &mut [bool], order: &mut Vec<usize>, next: &mut Vec<(usize, bool)>) {
        let (origin, muted) = unmuted_origin(self.graph, self, from);
        for node in muted {
            if !std::mem::replace(&mut seen[node], true) {
                order.push(node);
            }
        }
        if let Some(from) = origin.filter(|from| !seen[from.node]) {
            next.push((from.node, false));
        }
    }
}
