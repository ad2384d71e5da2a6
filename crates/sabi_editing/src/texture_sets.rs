//! Import of texture sets: a node for each image file, and a node that combines them into a material.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};

use sabi_engine::catalog::label_of;
use sabi_graph::{Edit, Node, NodeId, OutputRef, Value};

use crate::node_size::{NODE_WIDTH, size_of};
use crate::open_document::OpenDocument;
use crate::texture_map_names::{Map, MapName};
use crate::{new_nodes, relative_paths};

const IMAGE: &str = "source/image";
const COMBINE: &str = "material/combine";
const REMAP: &str = "adjust/remap";
/// Space between nodes, canvas points.
const GAP: f32 = 60.0;
/// Height of white above black in a height map, in working units. Texture files do not specify it.
const RELIEF: f64 = 0.02;

/// Image files of one set by map.
type Set = BTreeMap<Map, PathBuf>;

/// Adds the texture sets that these image files form by their names, as one step: for each set a material of all its maps,
/// which is selected.
pub fn add(document: &mut OpenDocument, files: &[PathBuf], pos: [f32; 2]) -> bool {
    let mut sets = sets_of(files);
    let packed = sets.values_mut().filter_map(|set| set.remove(&Map::Packed));
    let packed: Vec<String> = packed.map(|file| name_of(&file)).collect();
    sets.retain(|_, set| !set.is_empty());
    if !packed.is_empty() {
        let names = packed.join(", ");
        document.notify(format!(
            "{names} holds several channels in one picture and is left out; use a file for each"
        ));
    }
    if sets.is_empty() {
        let count = files.len();
        return document.refuse(format!(
            "none of these {count} files is named as a map of a texture set, as bricks_color.png or bricks_nor_gl.png are"
        ));
    }
    let mut builder = SetBuilder {
        document,
        edits: Vec::new(),
        taken: BTreeSet::new(),
    };
    let (mut materials, mut at) = (Vec::new(), pos);
    for (name, set) in &sets {
        let (material, bottom) = builder.add_set(name, set, at);
        materials.push(material);
        at[1] = bottom + GAP;
    }
    let edits = builder.edits;
    document.edit_and_select("Add texture set", edits, materials)
}

/// Texture sets that are being added: the edits so far, and the ids that they use.
struct SetBuilder<'d> {
    document: &'d mut OpenDocument,
    edits: Vec<Edit>,
    taken: BTreeSet<NodeId>,
}

impl SetBuilder<'_> {
    /// Adds one set. Returns its material and the vertical position of its lower end, canvas points.
    fn add_set(&mut self, name: &str, set: &Set, [x, y]: [f32; 2]) -> (NodeId, f32) {
        let step = NODE_WIDTH + GAP;
        let mut below = y;
        let mut inputs = BTreeMap::new();
        for (map, file) in set {
            let (input, output) = ports(*map);
            let image = self.add_image(*map, file, [x, below]);
            let mut from = OutputRef {
                node: image,
                port: output.map(str::to_owned),
            };
            if *map == Map::Height {
                from = self.add_relief(from, [x + step, below]);
            }
            inputs.insert(input.to_owned(), from);
            below += self.height(IMAGE) + GAP / 2.0;
        }
        let mut material = Node::new(COMBINE);
        material.label = Some(label_of(name)).filter(|label| !label.is_empty());
        material.inputs = inputs;
        let middle = ((y + below - self.height(COMBINE)) / 2.0).max(y);
        let id = self.add_node("material", material, [x + 2.0 * step, middle]);
        (id, below.max(middle + self.height(COMBINE)))
    }

    fn add_image(&mut self, map: Map, file: &Path, pos: [f32; 2]) -> NodeId {
        let mut image = Node::new(IMAGE);
        let (input, _) = ports(map);
        image.label = Some(label_of(input));
        match relative_paths::chosen(self.document, file) {
            Ok(path) => {
                image.params.insert("file".to_owned(), Value::Text(path));
            }
            Err(refused) => self.document.notify(refused.to_string()),
        }
        if map == (Map::Normal { is_down: true }) {
            image
                .params
                .insert("normal_y".to_owned(), Value::Text("down".to_owned()));
        }
        self.add_node(input, image, pos)
    }

    /// Adds a node that converts a height map, 0 to 1 with its middle on the model's surface, to heights in working units.
    fn add_relief(&mut self, from: OutputRef, pos: [f32; 2]) -> OutputRef {
        let mut remap = Node::new(REMAP);
        remap.inputs.insert("source".to_owned(), from);
        for (param, value) in [("to_low", -RELIEF / 2.0), ("to_high", RELIEF / 2.0)] {
            remap.params.insert(param.to_owned(), Value::Number(value));
        }
        let node = self.add_node("relief", remap, pos);
        OutputRef { node, port: None }
    }

    fn add_node(&mut self, stem: &str, mut node: Node, pos: [f32; 2]) -> NodeId {
        node.pos = pos.map(f32::round);
        let id = self.document.new_id(stem, &self.taken);
        self.taken.insert(id.clone());
        self.edits.push(new_nodes::addition(self.document, &id, node));
        id
    }

    fn height(&self, kind: &str) -> f32 {
        self.document
            .catalog()
            .entry(kind)
            .map_or(0.0, |entry| size_of(entry)[1])
    }
}

/// Image files by set and map: the first of several files for one map, and normal maps whose green points up before others.
fn sets_of(files: &[PathBuf]) -> BTreeMap<String, Set> {
    let mut sorted: Vec<&PathBuf> = files.iter().collect();
    sorted.sort();
    let mut sets: BTreeMap<String, Set> = BTreeMap::new();
    for file in sorted {
        let Some(name) = MapName::of(file) else { continue };
        let set = sets.entry(name.set).or_default();
        set.entry(name.map).or_insert_with(|| file.clone());
    }
    for set in sets.values_mut() {
        if set.contains_key(&Map::Normal { is_down: false }) {
            set.remove(&Map::Normal { is_down: true });
        }
    }
    sets
}

/// Channel that a map is connected to, and the output of the image node that it is read from, unless that is the first.
fn ports(map: Map) -> (&'static str, Option<&'static str>) {
    match map {
        Map::Color => ("base_color", None),
        Map::Roughness => ("roughness", Some("mask")),
        Map::Metallic => ("metallic", Some("mask")),
        Map::Occlusion => ("occlusion", Some("mask")),
        Map::Height => ("height", Some("mask")),
        Map::Normal { .. } => ("slope", Some("slope")),
        Map::Alpha => ("alpha", Some("mask")),
        // Packed maps are removed from the sets before.
        Map::Emission | Map::Packed => ("emission", None),
    }
}

fn name_of(file: &Path) -> String {
    file.file_name()
        .unwrap_or(file.as_os_str())
        .to_string_lossy()
        .into_owned()
}
