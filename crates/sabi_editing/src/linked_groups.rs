//! Groups that are linked to a file of a library: finding the file, updating to its newer version, and removing the link.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sabi_engine::OpenGraph;
use sabi_engine::effect_library::group_digest;
use sabi_files::{PathBase, TrustedPaths, Unread};
use sabi_graph::{Body, Document, Edit, GroupDef, INSTANCE_KNOBS, LibrarySource, Node, NodeId};

use crate::bundled_groups::{as_group, bundled};
use crate::open_document::OpenDocument;
use crate::{exposed_values, group_import, instances, relative_paths};

/// Returns a link to a library file: with the name of the library, or relative to the document if the file is in no library folder.
pub(crate) fn link_to(document: &OpenDocument, file: &Path) -> Option<LibrarySource> {
    let open = OpenGraph::open_trusting(file, &document.session.graph().trusted);
    let digest = group_digest(&open.ok()?).ok()?;
    let inside = document.library_folders.iter().find_map(|library| {
        let path = file.strip_prefix(&library.folder).ok()?;
        Some(format!("{}:{}", library.name, path.to_str()?.replace('\\', "/")))
    });
    let file = match inside {
        Some(file) => file,
        None => relative_paths::relative(document, file).ok()?,
    };
    Some(LibrarySource {
        file,
        digest,
        extra: BTreeMap::new(),
    })
}

/// Returns the file that a link refers to, if the document may open it. The file need not exist.
pub fn file_of(document: &OpenDocument, source: &LibrarySource) -> Option<PathBuf> {
    match source.file.split_once(':') {
        // A path with a drive has a single letter before the colon.
        Some((name, path)) if name.len() > 1 => {
            let library = document.library_folders.iter().find(|library| library.name == name)?;
            allowed(&TrustedPaths::default(), &PathBase::of_folder(&library.folder), path)
        }
        _ => {
            let graph = document.session.graph();
            allowed(&graph.trusted, &graph.base(), &source.file)
        }
    }
}

fn allowed(trusted: &TrustedPaths, base: &PathBase, written: &str) -> Option<PathBuf> {
    match trusted.check(base, written) {
        Err(Unread::Refused(_)) => None,
        _ => Some(base.resolve(written)),
    }
}

/// Replaces a group by the newer version in its library. Instances keep their knobs. Knobs that the newer version does not
/// have or whose values it refuses are reset, and wires to removed ports are removed.
pub fn update(document: &mut OpenDocument, group: &str) -> bool {
    match updating(document, document.contents(), group) {
        Ok((edits, lost)) => {
            let is_done = document.edit("Update from the library", edits);
            if is_done && !lost.is_empty() {
                document.notify(format!("'{group}' has no {} any more", lost.join(", ")));
            }
            is_done
        }
        Err(why) => {
            document.notify(why);
            false
        }
    }
}

/// Updates groups as [`update`] does, as one step. Returns whether any of them was updated.
pub fn update_all(document: &mut OpenDocument, groups: &[String]) -> bool {
    document.session.begin("Update from the library");
    let updated = groups.iter().filter(|group| update(document, group)).count();
    document.session.end();
    if updated > 0 {
        let groups = if updated == 1 { "group was" } else { "groups were" };
        document.notify(format!(
            "{updated} {groups} updated; undo brings the versions before back."
        ));
    }
    updated > 0
}

/// Returns the whole graph as if groups were updated by [`update_all`]; `None` if one of them cannot be updated.
pub fn updated(document: &OpenDocument, groups: &[String]) -> Option<OpenGraph> {
    let mut graph = document.session.graph().clone();
    for group in groups {
        let (edits, _) = updating(document, &graph.document, group).ok()?;
        graph.document.apply(Edit::Batch(edits)).ok()?;
    }
    Some(graph)
}

/// Edits that update a group in a state of the document, and the names of knobs and ports that instances lose.
fn updating(document: &OpenDocument, contents: &Document, group: &str) -> Result<(Vec<Edit>, Vec<String>), String> {
    let known = contents.groups.get(group);
    let source = known.and_then(|known| known.library.as_ref());
    let (Some(known), Some(source)) = (known, source) else {
        return Err(format!("'{group}' is linked to no file of a library"));
    };
    let file = file_of(document, source).ok_or_else(|| format!("the library of '{group}' is not there"))?;
    let graph = document.session.graph();
    let open = OpenGraph::open_trusting(&file, &graph.trusted).map_err(|error| error.to_string())?;
    let other = bundled(document, &open, &file)?;
    let nodes: BTreeMap<NodeId, Node> = other
        .graph
        .nodes()
        .map(|(id, node)| (id.clone(), node.clone()))
        .collect();
    let imported = group_import::import_groups(contents, &other, &nodes);
    let renamed = other.with_group_names(|name| imported.name(name).cloned());
    let made = GroupDef {
        name: known.name.clone(),
        library: link_to(document, &file),
        ..as_group(&renamed)
    };
    let mut lost = Vec::new();
    let mut edits = imported.edits;
    for (body, id, node) in instances::of_body(contents, &Body::Group(group.to_owned())) {
        edits.extend(resetting(&body, &id, &node, &made, &mut lost));
        let graph = contents.body(&body).ok();
        let inputs = graph
            .into_iter()
            .flat_map(|graph| graph.inputs(id.as_str()).into_keys());
        for input in inputs.filter(|input| !made.inputs.contains_key(*input)) {
            lost.push(input.to_owned());
            edits.push(Edit::Disconnect {
                body: body.clone(),
                node: id.clone(),
                input: input.to_owned(),
            });
        }
    }
    edits.extend(cut_readers(contents, group, &made, &mut lost));
    edits.push(Edit::SetGroup {
        name: group.to_owned(),
        group: Box::new(made),
    });
    lost.sort();
    lost.dedup();
    Ok((edits, lost))
}

/// Returns edits that reset the knobs of an instance that a new definition does not have.
fn resetting(body: &Body, id: &NodeId, node: &Node, made: &GroupDef, lost: &mut Vec<String>) -> Vec<Edit> {
    let fits = |(name, value): &(&String, &sabi_graph::Value)| {
        if name.as_str() == "variant" {
            return value
                .as_text()
                .is_some_and(|variant| made.graph.variants().contains_key(variant));
        }
        let Some(knob) = made.graph.exposed().get(*name) else {
            return INSTANCE_KNOBS.contains(&name.as_str());
        };
        exposed_values::range_fault(knob.range, value).is_none()
    };
    let mut edits = Vec::new();
    for (name, _) in node.params.iter().filter(|param| !fits(param)) {
        lost.push(name.clone());
        edits.push(Edit::SetParam {
            body: body.clone(),
            node: id.clone(),
            param: name.clone(),
            value: None,
        });
    }
    edits
}

/// Returns edits that remove the wires from outputs of instances that a new definition does not have.
fn cut_readers(contents: &Document, group: &str, made: &GroupDef, lost: &mut Vec<String>) -> Vec<Edit> {
    let mut edits = Vec::new();
    for (body, graph) in instances::bodies(contents) {
        for (id, _) in instances::instances(graph, group) {
            for reader in graph.readers(id.as_str()) {
                let from = graph.link_into(reader.node.as_str(), &reader.name);
                let port = from.and_then(|from| from.port.clone());
                if let Some(port) = port.filter(|port| !made.outputs.contains_key(port)) {
                    lost.push(port);
                    edits.push(Edit::Disconnect {
                        body: body.clone(),
                        node: reader.node,
                        input: reader.name,
                    });
                }
            }
        }
    }
    edits
}

/// Removes the link of a group. The group stays unchanged, as a group of this document.
pub fn unlink(document: &mut OpenDocument, group: &str) -> bool {
    let Some(known) = document
        .contents()
        .groups
        .get(group)
        .filter(|group| group.library.is_some())
    else {
        return document.refuse(format!("'{group}' is linked to no file of a library"));
    };
    let own = GroupDef {
        library: None,
        ..known.clone()
    };
    let edit = Edit::SetGroup {
        name: group.to_owned(),
        group: Box::new(own),
    };
    document.edit("Unlink from the library", vec![edit])
}
