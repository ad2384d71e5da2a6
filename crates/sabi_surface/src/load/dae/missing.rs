//! References of a file that lead nowhere.

use std::collections::{BTreeMap, BTreeSet};

use roxmltree::Node;

use crate::load::name_lists::listed;
use crate::load::text::part_name;
use crate::load::warnings::Warnings;

/// Maximum number of references that a warning lists.
const MOST_NAMED: usize = 5;

/// References to elements that the file does not have, each once.
#[derive(Default)]
pub(super) struct MissingReferences<'d> {
    /// To elements of this file, by what they are.
    inside: BTreeMap<&'static str, BTreeSet<&'d str>>,
    /// To elements of other files, by what they are.
    outside: BTreeMap<&'static str, BTreeSet<&'d str>>,
}

impl<'d> MissingReferences<'d> {
    /// Records the reference of an element.
    pub(super) fn add(&mut self, from: Node<'_, '_>, reference: &'d str) {
        let is_inside = reference.is_empty() || reference.starts_with('#');
        let references = if is_inside { &mut self.inside } else { &mut self.outside };
        references.entry(meant(from)).or_default().insert(reference);
    }

    /// Adds a warning about all references of a kind.
    pub(super) fn tell(&self, warnings: &mut Warnings) {
        let named = |references: &BTreeSet<&str>| {
            let names: Vec<String> = references.iter().map(|reference| part_name(reference)).collect();
            listed(names.iter().map(String::as_str), MOST_NAMED)
        };
        for (what, references) in &self.inside {
            warnings.add(format!(
                "The file refers to {what} that it does not have, which are left out: {}.",
                named(references)
            ));
        }
        for (what, references) in &self.outside {
            warnings.add(format!(
                "The file refers to {what} of other files, which are not read and left out: {}; export all as one file.",
                named(references)
            ));
        }
    }
}

/// Returns what an element refers to, in words for a warning.
fn meant(from: Node<'_, '_>) -> &'static str {
    match from.tag_name().name() {
        // Skins and morph targets refer to the mesh that they change.
        "instance_geometry" | "skin" | "morph" => "meshes",
        "instance_controller" => "skins or morph targets",
        "instance_node" => "nodes",
        "instance_visual_scene" => "scenes",
        "instance_material" => "materials",
        "instance_effect" => "effects of materials",
        "instance_image" => "pictures",
        // Inputs of polygons and skins refer to lists of numbers.
        _ => "sources",
    }
}

/// Returns true unless an element refers to another kind of element than it should.
pub(super) fn is_meant(from: Node<'_, '_>, target: Node<'_, '_>) -> bool {
    let kind = target.tag_name().name();
    match from.tag_name().name() {
        "instance_geometry" => kind == "geometry",
        // Some programs write controllers for meshes without any.
        "instance_controller" => kind == "controller" || kind == "geometry",
        "instance_visual_scene" => kind == "visual_scene",
        _ => true,
    }
}
