//! Proof that the documents of an archive name the same files as the originals.

use sabi_files::whole_path;
use sabi_graph::{FlatNode, flatten};

use super::named_files::{NamedDocument, all_variants};
use super::places::Places;
use super::rewritten_paths::{RewrittenDocument, entry_of};
use crate::error::{EngineError, ErrorKind};
use crate::opening::kinds::Kinds;
use crate::source::session_pictures::{base_of, named_file};

/// Checks that every node of the packed graph finds the picture that it finds in the original, in all variants.
///
/// # Errors
/// One does not. That is so where an instance gives a path to a group file, from which the path starts, and one of both lies outside of
/// the graph's folder.
pub(super) fn check(
    graph: &NamedDocument,
    packed: &[RewrittenDocument],
    places: &Places,
    kinds: &Kinds,
) -> Result<(), EngineError> {
    let main = &packed[0];
    let mut read = |name: &str| {
        let group = packed.iter().find(|document| document.name == name);
        group
            .map(|group| group.document.clone())
            .ok_or_else(|| format!("{name} is not in the archive"))
    };
    let mut faults = Vec::new();
    for overrides in all_variants(&graph.open.document) {
        // A graph that cannot be flattened, for example without a group file, is packed as it is.
        let Ok(before) = graph.open.flatten(&overrides) else {
            continue;
        };
        let after = flatten(&main.document, &overrides, &mut read).map_err(|error| {
            let why = format!("the packed graph is another one, which is a defect of Sabi: {error}");
            EngineError::new(ErrorKind::Defect, why)
        })?;
        for (before, after) in before.nodes.iter().zip(&after.nodes) {
            let written = |node| named_file(node, &kinds.sources).map_or("", |(_, written)| written);
            let base = graph.base();
            let base = base_of(&base, before);
            let wanted = places.of(&whole_path(&base, written(before)));
            let found = entry_of(after.file.as_deref().unwrap_or(&main.name), written(after));
            if written(before).is_empty() || wanted.is_none() || found.as_deref() == wanted {
                continue;
            }
            faults.push(sentence(graph, before, written(before)));
        }
    }
    faults.dedup();
    match faults.is_empty() {
        true => Ok(()),
        false => Err(EngineError::several(ErrorKind::BadInput, faults)),
    }
}

fn sentence(graph: &NamedDocument, node: &FlatNode, written: &str) -> String {
    format!(
        "{}: node '{}' ({}) gets the path {written} from outside of its group file, so that it cannot be rewritten; copy the group file \
         and the picture below the folder of the graph",
        graph.open.path.display(),
        node.id,
        node.kind
    )
}
