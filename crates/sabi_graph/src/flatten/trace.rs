//! Follows links through reroutes and the borders of groups to nodes of the flat graph.

use std::collections::{BTreeMap, BTreeSet};

use super::definitions::{Definition, Definitions};
use super::expand::{ExpandedNode, Expansion};
use super::{FlatRef, FlattenError};
use crate::problem::{hint, listed, quoted};
use crate::{NodeId, OutputRef};

/// Inputs of nodes in a group, each with the group input that feeds it.
type FedInputs<'a> = BTreeMap<&'a str, BTreeMap<&'a str, &'a str>>;

pub(super) struct Tracer<'a> {
    expansion: &'a Expansion,
    definitions: Vec<Definition<'a>>,
    /// Fed inputs, by number of the graph.
    fed: Vec<FedInputs<'a>>,
    /// Origins of reroutes found so far, by instance and id.
    reroute_origins: BTreeMap<(usize, &'a NodeId), Option<FlatRef>>,
}

impl<'a> Tracer<'a> {
    pub(super) fn new(all: &'a Definitions<'_>, expansion: &'a Expansion) -> Self {
        let definitions: Vec<Definition<'a>> = (0..all.len()).map(|number| all.get(number)).collect();
        let fed = definitions.iter().map(fed_inputs).collect();
        Tracer {
            expansion,
            definitions,
            fed,
            reroute_origins: BTreeMap::new(),
        }
    }

    /// Returns the links of the node `id` of an instance. Inputs whose link ends at an unconnected reroute or group input are left out.
    pub(super) fn inputs(
        &mut self,
        instance: usize,
        id: &'a NodeId,
    ) -> Result<BTreeMap<String, FlatRef>, FlattenError> {
        let number = self.expansion.instances[instance].definition;
        let own = self.definitions[number].graph.inputs(id.as_str());
        let fed = self.fed[number]
            .get(id.as_str())
            .into_iter()
            .flat_map(BTreeMap::keys)
            .copied();
        let names: BTreeSet<&str> = own.keys().copied().chain(fed).collect();
        let mut inputs = BTreeMap::new();
        for name in names {
            let own = own.get(name).map(|from| (instance, *from));
            if let Some((inside, from)) = self.link_from_outside(instance, id, name).or(own)
                && let Some(found) = self.trace(inside, from)?
            {
                inputs.insert(name.to_owned(), found);
            }
        }
        Ok(inputs)
    }

    /// Returns the link of an input and the instance that contains the link: the link from outside the group if there is
    /// one, otherwise the input's own link.
    fn link(&self, instance: usize, id: &NodeId, input: &str) -> Option<(usize, &'a OutputRef)> {
        self.link_from_outside(instance, id, input).or_else(|| {
            let graph = self.definitions[self.expansion.instances[instance].definition].graph;
            Some((instance, graph.link_into(id.as_str(), input)?))
        })
    }

    /// Returns the link into the input of the group that feeds an input, and the instance that contains the link.
    fn link_from_outside(&self, instance: usize, id: &NodeId, input: &str) -> Option<(usize, &'a OutputRef)> {
        let inner = &self.expansion.instances[instance];
        let (outer, node) = inner.parent.as_ref()?;
        let fed = self.fed[inner.definition].get(id.as_str())?;
        // This recursion is as deep as the instances are nested.
        self.link(*outer, node, fed.get(input)?)
    }

    /// Returns the node of the flat graph at the start of a link; `None` for an unconnected reroute.
    pub(super) fn trace(
        &mut self,
        mut instance: usize,
        mut from: &'a OutputRef,
    ) -> Result<Option<FlatRef>, FlattenError> {
        let mut passed = Vec::new();
        let found = loop {
            match self.expanded(instance, &from.node) {
                None => break None,
                Some(ExpandedNode::Node(node)) => {
                    break Some(FlatRef {
                        node,
                        port: from.port.clone(),
                    });
                }
                Some(ExpandedNode::Instance(inner)) => {
                    from = self.output(instance, inner, from)?;
                    instance = inner;
                }
                Some(ExpandedNode::Reroute) => {
                    if let Some(port) = &from.port {
                        let node = quoted(&self.path(instance, &from.node));
                        return Err(FlattenError::ReroutePort {
                            node,
                            port: quoted(port),
                        });
                    }
                    if let Some(found) = self.reroute_origins.get(&(instance, &from.node)) {
                        break found.clone();
                    }
                    passed.push((instance, &from.node));
                    match self.link(instance, &from.node, "source") {
                        Some((inside, next)) => (instance, from) = (inside, next),
                        None => break None,
                    }
                }
            }
        };
        self.reroute_origins
            .extend(passed.into_iter().map(|wire| (wire, found.clone())));
        Ok(found)
    }

    fn expanded(&self, instance: usize, id: &NodeId) -> Option<ExpandedNode> {
        self.expansion.expanded.get(&instance)?.get(id).copied()
    }

    fn path(&self, instance: usize, id: &NodeId) -> String {
        format!("{}{id}", self.expansion.instances[instance].prefix)
    }

    /// Returns the result inside a group that one of the group's outputs passes on.
    fn output(&self, outer: usize, inner: usize, from: &OutputRef) -> Result<&'a OutputRef, FlattenError> {
        let outputs = self.definitions[self.expansion.instances[inner].definition].outputs;
        let names = || outputs.keys().map(String::as_str);
        let instance = || quoted(&self.path(outer, &from.node));
        match &from.port {
            Some(port) => outputs.get(port).ok_or_else(|| FlattenError::NoSuchOutput {
                instance: instance(),
                port: quoted(port),
                hint: hint(port, names()),
                known: listed(names()),
            }),
            None if outputs.len() == 1 => outputs
                .values()
                .next()
                .ok_or_else(|| self.ambiguous(instance(), names())),
            None => Err(self.ambiguous(instance(), names())),
        }
    }

    fn ambiguous<'n>(&self, instance: String, names: impl Iterator<Item = &'n str>) -> FlattenError {
        let known = listed(names);
        FlattenError::OutputNotNamed { instance, known }
    }
}

fn fed_inputs<'a>(definition: &Definition<'a>) -> FedInputs<'a> {
    let mut fed = FedInputs::new();
    for (name, input) in definition.inputs {
        for slot in &input.to {
            fed.entry(slot.node.as_str()).or_default().insert(&slot.name, name);
        }
    }
    fed
}
