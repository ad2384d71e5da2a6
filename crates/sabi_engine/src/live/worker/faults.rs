//! Flattening of a request's graph, and its faults.

use std::collections::{BTreeMap, BTreeSet};
use std::path::PathBuf;

use sabi_files::Refusal;
use sabi_graph::{FlatGraph, NodeRef, ResultOrigin};
use sabi_plan::{FileContents, PlanError, Target};

use super::{Job, Worker};
use crate::evaluating::outputs::duplicate_map_names;
use crate::live::event::{BlockedNode, GraphFaults, LiveEvent, NodeFault};
use crate::live::flattened_request::FlattenedRequest;
use crate::live::groups::{OpenedGroups, open_groups};
use crate::live::request::ViewSubject;
use crate::opening::graph_faults::{planner_without_model, targets_of_all_nodes};
use crate::source::{SourceKinds, session_pictures};
use crate::warning::Warning;

impl Worker {
    /// Flattens the graph of a request and sends its faults. Returns `None` if it cannot be flattened.
    pub(super) fn flatten(&mut self, job: &Job) -> Option<FlattenedRequest> {
        let request = &job.request;
        let subject = request.subjects.iter().filter_map(|subject| match subject {
            ViewSubject::Node(node) => Some(node),
            ViewSubject::Outputs => None,
        });
        let named = subject.chain(&request.inspected).chain(&request.thumbnails);
        let named: Vec<NodeRef> = named.cloned().collect::<BTreeSet<_>>().into_iter().collect();
        let mut files = BTreeSet::new();
        let OpenedGroups {
            graph,
            found,
            failed_groups,
            mut refused,
        } = match open_groups(&job.graph, &named, &mut files) {
            Ok(opened) => opened,
            Err(error) => {
                self.send_files(job, files, Vec::new());
                let other = error.messages;
                self.send_faults_if_changed(
                    job,
                    GraphFaults {
                        other,
                        ..GraphFaults::default()
                    },
                );
                return None;
            }
        };
        files.extend(session_pictures::files(
            &job.graph.base(),
            &job.graph.trusted,
            &graph,
            &request.kinds.sources,
        ));
        refused.extend(session_pictures::refused(
            &job.graph.base(),
            &job.graph.trusted,
            &graph,
            &request.kinds.sources,
        ));
        self.send_files(job, files, refused);
        let mut other = duplicate_map_names(&graph);
        let targets = targets_of(named, found, &mut other);
        let contents = job.graph.file_contents(&graph, &request.kinds, 0..graph.nodes.len());
        let flattened = FlattenedRequest {
            faults: with_failed_groups(faults_of(job, &graph, &contents, other), failed_groups),
            graph,
            found: targets,
            contents,
            kinds_revision: request.kinds_revision,
        };
        self.failed_nodes.retain(|id, failed| flattened.still_fails(id, failed));
        self.send_faults(job, &flattened);
        Some(flattened)
    }

    /// Sends the files that the graph names, and the refusals of those that it may not open, if they have changed.
    fn send_files(&mut self, job: &Job, files: BTreeSet<PathBuf>, refused: Vec<Refusal>) {
        let now = (files, refused);
        if self.sent.files.as_ref() == Some(&now) {
            return;
        }
        self.sent.files = Some(now.clone());
        let (files, refused) = now;
        self.send(LiveEvent::Files {
            revision: job.request.revision,
            files,
            refused,
        });
    }

    /// Sends all faults, if they have changed.
    pub(super) fn send_faults(&mut self, job: &Job, flattened: &FlattenedRequest) {
        let mut faults = flattened.faults.clone();
        let failed = self.failed_nodes.iter().map(|(node, failed)| NodeFault {
            node: node.clone(),
            sentence: failed.why.clone(),
        });
        faults.faults.extend(failed);
        let too_long = self.failed_nodes.iter().filter(|(_, failed)| failed.is_too_long);
        faults.too_long = too_long.map(|(node, _)| node.clone()).collect();
        for id in self.failed_nodes.keys() {
            let downstream = flattened.downstream(id).filter(|node| !is_named(&faults, node));
            let blocked: Vec<BlockedNode> = downstream
                .map(|node| BlockedNode {
                    node: node.to_owned(),
                    blocked_by: id.clone(),
                })
                .collect();
            faults.blocked.extend(blocked);
        }
        if let Some(loaded) = &self.loaded {
            for warning in loaded.warnings() {
                if faults.warnings.iter().all(|known| known.sentence != warning.sentence) {
                    faults.warnings.push(warning);
                }
            }
        }
        self.send_faults_if_changed(job, faults);
    }

    fn send_faults_if_changed(&mut self, job: &Job, faults: GraphFaults) {
        if self.sent.faults.as_ref() == Some(&faults) {
            return;
        }
        self.sent.faults = Some(faults.clone());
        self.send(LiveEvent::Faults {
            revision: job.request.revision,
            faults,
        });
    }
}

/// Returns the targets of nodes, given where their results come from. Faults are added to `other`.
fn targets_of(named: Vec<NodeRef>, found: Vec<ResultOrigin>, other: &mut Vec<String>) -> BTreeMap<NodeRef, Target> {
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
    targets
}

fn is_named(faults: &GraphFaults, node: &str) -> bool {
    faults.blocked.iter().any(|blocked| blocked.node == node) || faults.faults.iter().any(|fault| fault.node == node)
}

/// Replaces the faults of the nodes that represent failed group instances by the reasons of their failures.
fn with_failed_groups(mut faults: GraphFaults, failed_groups: BTreeMap<String, String>) -> GraphFaults {
    faults.faults.retain(|fault| !failed_groups.contains_key(&fault.node));
    let failed_groups = failed_groups.into_iter();
    let told = failed_groups.map(|(node, sentence)| NodeFault { node, sentence });
    faults.faults.extend(told);
    faults
}

/// Collects the faults of all nodes of a graph, whether or not their results are wanted.
fn faults_of(job: &Job, graph: &FlatGraph, contents: &FileContents, other: Vec<String>) -> GraphFaults {
    let resolved = planner_without_model(graph, &job.request.kinds, contents).resolve(&targets_of_all_nodes(graph));
    let (warnings, errors): (Vec<&PlanError>, Vec<&PlanError>) =
        resolved.errors.iter().partition(|error| error.is_warning());
    let unchosen = nodes_without_files(graph, &job.request.kinds.sources);
    let faults = errors.iter().filter(|error| !unchosen.contains(error.node.as_str()));
    let faults: Vec<NodeFault> = faults
        .map(|error| NodeFault {
            node: error.node.clone(),
            sentence: error.to_string(),
        })
        .collect();
    let at_fault: BTreeSet<&str> = errors.iter().map(|error| error.node.as_str()).collect();
    let mut blocked_by: BTreeMap<usize, &str> = BTreeMap::new();
    // A node comes after its inputs in a flat graph.
    for (index, node) in graph.nodes.iter().enumerate() {
        if at_fault.contains(node.id.as_str()) || resolved.nodes[index].is_some() {
            continue;
        }
        let on = node.inputs.values().find_map(|from| {
            let id = graph.nodes[from.node].id.as_str();
            let is_at_fault = at_fault.contains(id);
            is_at_fault
                .then_some(id)
                .or_else(|| blocked_by.get(&from.node).copied())
        });
        if let Some(on) = on {
            blocked_by.insert(index, on);
        }
    }
    let blocked = blocked_by.iter().filter(|(index, _)| !graph.nodes[**index].muted);
    GraphFaults {
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
                ..Warning::from(error.to_string())
            })
            .collect(),
        faults,
        unchosen: unchosen
            .into_iter()
            .map(|node| NodeFault {
                node: node.to_owned(),
                sentence: "Choose a picture.".to_owned(),
            })
            .collect(),
        other,
        too_long: Vec::new(),
    }
}

/// Returns the nodes that read a file for which none is chosen. Muted nodes read no file.
fn nodes_without_files<'g>(graph: &'g FlatGraph, sources: &SourceKinds) -> BTreeSet<&'g str> {
    let nodes = graph.nodes.iter().filter(|node| !node.muted);
    let unchosen =
        nodes.filter(|node| session_pictures::named_file(node, sources).is_some_and(|(_, path)| path.is_empty()));
    unchosen.map(|node| node.id.as_str()).collect()
}
