//! The graph without its groups, and what is wrong with it.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use sabi_graph::{FlatGraph, NodeRef, Value};
use sabi_plan::{FileContents, PlanError, Target};

use super::event::{BlockedNode, Faults, LiveEvent, NodeFault, Warning};
use super::groups::{Ungrouped, open_groups};
use super::model::Loaded;
use super::request::ViewSubject;
use super::worker::{Job, Worker};
use crate::evaluating::outputs::clashes;
use crate::opening::modelless::{all_nodes, planner};
use crate::opening::pictures;

/// The graph of a wish, flat, and where in it the wanted results are.
pub(super) struct FlattenedRequest {
    pub(super) graph: FlatGraph,
    /// What the wish names, as far as it is there.
    pub(super) found: BTreeMap<NodeRef, Target>,
    contents: FileContents,
    /// What is wrong, before anything is evaluated.
    faults: Faults,
}

/// A node whose result could not be made, and what that hangs on: once it changes the node is tried again.
pub(super) struct FailedNode {
    why: String,
    params: BTreeMap<String, Value>,
    content: Option<[u8; 32]>,
}

impl Worker {
    /// Flattens the graph of a wish and tells what is wrong with it; nothing where it cannot be flattened.
    pub(super) fn flatten(&mut self, job: &Job) -> Option<FlattenedRequest> {
        let request = &job.request;
        let subject = request.subjects.iter().filter_map(|subject| match subject {
            ViewSubject::Node(node) => Some(node),
            ViewSubject::Outputs => None,
        });
        let named = subject.chain(&request.inspected).chain(&request.thumbnails);
        let named: Vec<NodeRef> = named.cloned().collect::<BTreeSet<_>>().into_iter().collect();
        let mut files = BTreeSet::new();
        let Ungrouped {
            graph,
            found,
            failed_groups,
        } = match open_groups(&request.graph, &named, &mut files) {
            Ok(opened) => opened,
            Err(error) => {
                self.tell_files(job, files);
                let other = error.messages;
                self.tell_if_new(
                    job,
                    Faults {
                        other,
                        ..Faults::default()
                    },
                );
                return None;
            }
        };
        files.extend(pictures::files(request.graph.folder(), &graph, &request.kinds));
        self.tell_files(job, files);
        let mut other = clashes(&graph);
        let mut targets = BTreeMap::new();
        for (node, found) in named.into_iter().zip(found) {
            match found {
                Ok(Some(from)) => {
                    let target = Target {
                        node: from.node,
                        port: from.port,
                    };
                    targets.insert(node, target);
                }
                Ok(None) => {}
                Err(error) => other.push(error.to_string()),
            }
        }
        let contents = request
            .graph
            .file_contents(&graph, &request.kinds, 0..graph.nodes.len());
        let flattened = FlattenedRequest {
            faults: with_failed_groups(faults_of(job, &graph, &contents, other), failed_groups),
            graph,
            found: targets,
            contents,
        };
        self.failed_nodes
            .retain(|id, failed_nodes| flattened.still_fails(id, failed_nodes));
        self.tell_faults(job, &flattened);
        Some(flattened)
    }

    /// Tells which files the graph names, if they are others than before.
    fn tell_files(&mut self, job: &Job, files: BTreeSet<PathBuf>) {
        if self.sent.files.as_ref() == Some(&files) {
            return;
        }
        self.sent.files = Some(files.clone());
        self.tell(LiveEvent::Files {
            revision: job.request.revision,
            files,
        });
    }

    /// Tells what is wrong, if that has changed.
    pub(super) fn tell_faults(&mut self, job: &Job, flattened: &FlattenedRequest) {
        let mut faults = flattened.faults.clone();
        let failed_nodes = self.failed_nodes.iter().map(|(node, failed_nodes)| NodeFault {
            node: node.clone(),
            sentence: failed_nodes.why.clone(),
        });
        faults.faults.extend(failed_nodes);
        for id in self.failed_nodes.keys() {
            let waits = flattened.behind(id).filter(|node| !is_named(&faults, node));
            let blocked: Vec<BlockedNode> = waits
                .map(|node| BlockedNode {
                    node: node.to_owned(),
                    blocked_by: id.clone(),
                })
                .collect();
            faults.blocked.extend(blocked);
        }
        if let Some(sized) = self.loaded.as_mut().and_then(Loaded::first) {
            for sentence in sized.warnings() {
                if faults.warnings.iter().all(|known| known.sentence != *sentence) {
                    faults.warnings.push(Warning {
                        node: None,
                        sentence: sentence.clone(),
                    });
                }
            }
        }
        self.tell_if_new(job, faults);
    }

    fn tell_if_new(&mut self, job: &Job, faults: Faults) {
        if self.sent.faults.as_ref() == Some(&faults) {
            return;
        }
        self.sent.faults = Some(faults.clone());
        self.tell(LiveEvent::Faults {
            revision: job.request.revision,
            faults,
        });
    }
}

impl FlattenedRequest {
    /// Takes down that a node's result cannot be made. Says whether that was news of a node of this graph: anything else is a
    /// mistake, and trying again would not end.
    pub(super) fn record_failure(
        &self,
        failed_nodes: &mut BTreeMap<String, FailedNode>,
        node: &str,
        why: &str,
    ) -> bool {
        let Some(index) = self.graph.find(node) else {
            return false;
        };
        let found = FailedNode {
            why: why.to_owned(),
            params: self.graph.nodes[index].params.clone(),
            content: self.content(index),
        };
        failed_nodes.insert(node.to_owned(), found).is_none()
    }

    fn content(&self, node: usize) -> Option<[u8; 32]> {
        self.contents.get(&node)?.as_ref().ok().copied()
    }

    fn still_fails(&self, id: &str, failed_nodes: &FailedNode) -> bool {
        self.graph.find(id).is_some_and(|index| {
            let node = &self.graph.nodes[index];
            !node.muted && node.params == failed_nodes.params && self.content(index) == failed_nodes.content
        })
    }

    /// Ids of all nodes that need a node.
    fn behind(&self, id: &str) -> impl Iterator<Item = &str> {
        let index = self.graph.find(id);
        let needs = move |node: &usize| {
            Some(*node) != index && index.is_some_and(|index| self.graph.upstream(&[*node]).contains(&index))
        };
        let nodes = (0..self.graph.nodes.len()).filter(needs);
        nodes.map(|node| self.graph.nodes[node].id.as_str())
    }

    /// Those of some targets that need no broken node.
    pub(super) fn sound(&self, targets: &[Target], failed_nodes: &BTreeMap<String, FailedNode>) -> Vec<Target> {
        if failed_nodes.is_empty() {
            return targets.to_vec();
        }
        let failed_nodes: Vec<usize> = failed_nodes.keys().filter_map(|id| self.graph.find(id)).collect();
        let is_sound = |target: &&Target| {
            // The model's own looks, which stand after all nodes of the graph, need none of them.
            let needed = self.graph.upstream(&[target.node]);
            !failed_nodes.iter().any(|failed_nodes| needed.contains(failed_nodes))
        };
        targets.iter().filter(is_sound).cloned().collect()
    }
}

fn is_named(faults: &Faults, node: &str) -> bool {
    faults.blocked.iter().any(|blocked| blocked.node == node) || faults.faults.iter().any(|fault| fault.node == node)
}

/// What is wrong, with why instances were set aside in the place of what is said of their stand-ins.
fn with_failed_groups(mut faults: Faults, failed_groups: BTreeMap<String, String>) -> Faults {
    faults.faults.retain(|fault| !failed_groups.contains_key(&fault.node));
    let failed_groups = failed_groups.into_iter();
    let told = failed_groups.map(|(node, sentence)| NodeFault { node, sentence });
    faults.faults.extend(told);
    faults
}

/// What is wrong with all nodes of a graph, whoever needs them.
fn faults_of(job: &Job, graph: &FlatGraph, contents: &FileContents, other: Vec<String>) -> Faults {
    let resolved = planner(graph, &job.request.kinds, contents).resolve(&all_nodes(graph));
    let (warnings, errors): (Vec<&PlanError>, Vec<&PlanError>) =
        resolved.errors.iter().partition(|error| error.is_warning());
    let faults: Vec<NodeFault> = errors
        .iter()
        .map(|error| NodeFault {
            node: error.node.clone(),
            sentence: error.to_string(),
        })
        .collect();
    let at_fault: BTreeSet<&str> = errors.iter().map(|error| error.node.as_str()).collect();
    let mut waits_for: BTreeMap<usize, &str> = BTreeMap::new();
    // Inputs stand before those who read them.
    for (index, node) in graph.nodes.iter().enumerate() {
        if at_fault.contains(node.id.as_str()) || resolved.nodes[index].is_some() {
            continue;
        }
        let on = node.inputs.values().find_map(|from| {
            let id = graph.nodes[from.node].id.as_str();
            let is_at_fault = at_fault.contains(id);
            is_at_fault.then_some(id).or_else(|| waits_for.get(&from.node).copied())
        });
        if let Some(on) = on {
            waits_for.insert(index, on);
        }
    }
    let blocked = waits_for.iter().filter(|(index, _)| !graph.nodes[**index].muted);
    Faults {
        blocked: blocked
            .map(|(index, on)| BlockedNode {
                node: graph.nodes[*index].id.clone(),
                blocked_by: (*on).to_owned(),
            })
            .collect(),
        warnings: warnings
            .iter()
            .map(|error| Warning {
                node: Some(error.node.clone()),
                sentence: error.to_string(),
            })
            .collect(),
        faults,
        other,
    }
}
