//! Builder of steps from the resolved graph and its groups.

use std::collections::BTreeMap;

use sabi_graph::PortType;
use sabi_nodes::kind::Channel;
use sabi_nodes::link::StoredLayout;

use crate::fuse::{FusionGroup, ResultReaders, ResultRef};
use crate::request::Planner;
use crate::resolved_graph::{ResolvedGraph, ResolvedNode};

/// Builder of the steps of a plan.
pub(crate) struct StepBuilder<'p, 'a> {
    pub(crate) planner: &'p Planner<'a>,
    pub(crate) resolved: &'p ResolvedGraph<'a>,
    /// Index of the group that produces each value.
    pub(crate) producer: BTreeMap<ResultRef, usize>,
    readers: ResultReaders,
    /// Channels of materials in kernels that do not depend on links.
    pub(crate) switched_channels: &'static [Channel],
}

impl<'p, 'a> StepBuilder<'p, 'a> {
    pub(crate) fn new(
        planner: &'p Planner<'a>,
        resolved: &'p ResolvedGraph<'a>,
        groups: &[FusionGroup],
        readers: ResultReaders,
    ) -> StepBuilder<'p, 'a> {
        let made = groups
            .iter()
            .enumerate()
            .flat_map(|(at, group)| group.values().into_iter().map(move |value| (value, at)));
        StepBuilder {
            planner,
            resolved,
            producer: made.collect(),
            readers,
            switched_channels: Channel::switched(resolved.nodes.iter().flatten().flat_map(ResolvedNode::all_channels)),
        }
    }

    /// A node of a group.
    pub(crate) fn node(&self, node: usize) -> &ResolvedNode<'_> {
        self.resolved.nodes[node].as_ref().unwrap_or_else(|| {
            unreachable!(
                "'{}' is not resolved, and only resolved nodes are grouped",
                self.id(node)
            )
        })
    }

    /// Id of a node.
    pub(crate) fn id(&self, node: usize) -> String {
        self.planner.graph.nodes[node].id.clone()
    }

    /// Name and type of a value.
    pub(crate) fn output(&self, (node, output): ResultRef) -> (&str, PortType) {
        self.node(node)
            .output(output)
            .unwrap_or_else(|| unreachable!("'{}' has no result {output}", self.id(node)))
    }

    /// Type and stored channels of a value.
    pub(crate) fn stored(&self, (node, output): ResultRef) -> StoredLayout {
        let (_, ty) = self.output((node, output));
        let channels = if ty == PortType::Material {
            self.node(node).channels[output].clone()
        } else {
            Vec::new()
        };
        StoredLayout { ty, channels }
    }

    /// Returns true if a node of another group reads a value.
    pub(crate) fn is_read_outside(&self, value: ResultRef, group: usize) -> bool {
        let readers = self.readers.get(&value).into_iter().flatten();
        let groups = |reader: &usize| self.producer.range((*reader, 0)..(*reader + 1, 0));
        readers.flat_map(groups).any(|(_, producer)| *producer != group)
    }
}
