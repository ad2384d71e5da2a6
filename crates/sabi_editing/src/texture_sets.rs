//! Import of texture sets: a node for each image file, and a node that combines them into a material.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::Read as _;
use std::path::{Path, PathBuf};

use sabi_graph::{Edit, Node, NodeId, OutputRef, Value};
use sabi_nodes::label_of;

use crate::node_size::{NODE_WIDTH, size_of};
use crate::open_document::OpenDocument;
use crate::texture_map_names::{ChannelReading, MapName};
use crate::{new_nodes, relative_paths, wires};

const IMAGE: &str = "source/image";
const COMBINE: &str = "material/combine";
const REMAP: &str = "adjust/remap";
const INVERT: &str = "adjust/invert";
/// Space between nodes, canvas points.
const GAP: f32 = 60.0;
/// Height of white above black in a height map, in working units. Texture files do not specify it.
const RELIEF: f64 = 0.02;

/// Image of a set, with the channels that are read from it.
struct SetPicture {
    file: PathBuf,
    readings: Vec<ChannelReading>,
}

/// Adds the texture sets that these image files form according to their names, as one undo step. Each set becomes a
/// material of all its maps, which is selected.
pub fn add(document: &mut OpenDocument, files: &[PathBuf], pos: [f32; 2]) -> bool {
    let Sets { sets, left_out } = Sets::of(files);
    for sentence in left_out {
        document.notify(sentence);
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
    let mut edits = builder.edits;
    let size = [3.0 * NODE_WIDTH + 2.0 * GAP, at[1] - GAP - pos[1]];
    move_to_free(document, &mut edits, pos, size);
    document.edit_and_select("Add texture set", edits, materials)
}

/// Moves nodes that are added in a box of this size, at `pos`, so that the box covers no other node.
fn move_to_free(document: &OpenDocument, edits: &mut [Edit], pos: [f32; 2], size: [f32; 2]) {
    let others: Vec<&NodeId> = document.graph().ids().collect();
    // With a gap on all sides.
    let corner = pos.map(|at| at - GAP);
    let free = wires::uncovering(document, corner, size.map(|side| side + 2.0 * GAP), &others);
    let way = [free[0] - corner[0], free[1] - corner[1]];
    for edit in edits {
        if let Edit::AddNode { node, .. } = edit {
            node.pos = [(node.pos[0] + way[0]).round(), (node.pos[1] + way[1]).round()];
        }
    }
}

/// State while texture sets are added: the edits so far, and the ids that they use.
struct SetBuilder<'d> {
    document: &'d mut OpenDocument,
    edits: Vec<Edit>,
    taken: BTreeSet<NodeId>,
}

impl SetBuilder<'_> {
    /// Adds one set. Returns its material and the vertical position of its lower edge, canvas points.
    fn add_set(&mut self, name: &str, set: &[SetPicture], [x, y]: [f32; 2]) -> (NodeId, f32) {
        let step = NODE_WIDTH + GAP;
        let mut below = y;
        let mut inputs = BTreeMap::new();
        for picture in set {
            let image = self.add_image(picture, [x, below]);
            let mut converted_below = below;
            for reading in &picture.readings {
                let mut from = OutputRef {
                    node: image.clone(),
                    port: reading.output.map(str::to_owned),
                };
                let mut at = [x + step, converted_below];
                if reading.is_inverted {
                    from = self.add_inverted(from, at);
                    at[1] += self.height(INVERT) + GAP / 2.0;
                }
                if reading.channel == "height" {
                    from = self.add_relief(from, at);
                    at[1] += self.height(REMAP) + GAP / 2.0;
                }
                converted_below = at[1];
                inputs.insert(reading.channel.clone(), from);
            }
            below = (below + self.height(IMAGE) + GAP / 2.0).max(converted_below);
        }
        let mut material = Node::new(COMBINE);
        material.label = Some(label_of(name)).filter(|label| !label.is_empty());
        let middle = ((y + below - self.height(COMBINE)) / 2.0).max(y);
        let id = self.add_node("material", material, inputs, [x + 2.0 * step, middle]);
        (id, below.max(middle + self.height(COMBINE)))
    }

    fn add_image(&mut self, picture: &SetPicture, pos: [f32; 2]) -> NodeId {
        let mut image = Node::new(IMAGE);
        // An image of a color with alpha is named after its first channel. An image that packs several channels is named after its file.
        let packs_several = picture
            .readings
            .iter()
            .filter(|reading| reading.output != Some("alpha"))
            .count()
            > 1;
        let stem = match picture.readings.first() {
            Some(reading) if !packs_several => reading.channel.clone(),
            _ => "packed".to_owned(),
        };
        image.label = Some(match packs_several {
            true => stem_of(&picture.file),
            // As artists and their files call the map that slopes are read from.
            false if stem == "slope" => "Normal".to_owned(),
            false => label_of(&stem),
        });
        match relative_paths::chosen(self.document, &picture.file) {
            Ok(path) => {
                image.params.insert("file".to_owned(), Value::Text(path));
            }
            Err(refused) => self.document.notify(refused.to_string()),
        }
        if picture.readings.iter().any(|reading| reading.is_green_down) {
            image
                .params
                .insert("normal_y".to_owned(), Value::Text("down".to_owned()));
        }
        self.add_node(&stem, image, BTreeMap::new(), pos)
    }

    /// Adds a node that computes 1 minus a mask, for example the roughness from a smoothness.
    fn add_inverted(&mut self, from: OutputRef, pos: [f32; 2]) -> OutputRef {
        let source = BTreeMap::from([("source".to_owned(), from)]);
        let node = self.add_node("inverted", Node::new(INVERT), source, pos);
        OutputRef { node, port: None }
    }

    /// Adds a node that converts a height map to heights in working units. Height maps range from 0 to 1, and 0.5 lies on
    /// the model's surface.
    fn add_relief(&mut self, from: OutputRef, pos: [f32; 2]) -> OutputRef {
        let mut remap = Node::new(REMAP);
        for (param, value) in [("to_low", -RELIEF / 2.0), ("to_high", RELIEF / 2.0)] {
            remap.params.insert(param.to_owned(), Value::Number(value));
        }
        let source = BTreeMap::from([("source".to_owned(), from)]);
        let node = self.add_node("relief", remap, source, pos);
        OutputRef { node, port: None }
    }

    fn add_node(&mut self, stem: &str, mut node: Node, inputs: BTreeMap<String, OutputRef>, pos: [f32; 2]) -> NodeId {
        node.pos = pos.map(f32::round);
        let id = self.document.new_id(stem, &self.taken);
        self.taken.insert(id.clone());
        self.edits.push(new_nodes::addition(self.document, &id, node, inputs));
        id
    }

    fn height(&self, kind: &str) -> f32 {
        self.document
            .catalog()
            .entry(kind)
            .map_or(0.0, |entry| size_of(entry)[1])
    }
}

/// Texture sets of some files.
struct Sets {
    /// Images by the names of their sets.
    sets: BTreeMap<String, Vec<SetPicture>>,
    /// Sentences about files that are not used.
    left_out: Vec<String>,
}

impl Sets {
    /// Sorts image files into sets. If several images contain a channel, an image with only that channel is preferred to
    /// one that packs several, and normal maps whose green points up are preferred to others.
    fn of(files: &[PathBuf]) -> Sets {
        let mut named: Vec<(&PathBuf, MapName)> = files
            .iter()
            .filter_map(|file| Some((file, MapName::of(file)?)))
            .collect();
        named.sort_by_key(|(file, name)| {
            let is_down = name.readings.iter().any(|reading| reading.is_green_down);
            (name.tile, name.readings.len(), is_down, *file)
        });
        let first_tiles = named
            .iter()
            .filter_map(|(_, name)| Some((name.set.clone(), name.tile?)));
        // For duplicate keys, `collect` keeps the last value. The order is reversed so that this is the first one of the sorted list.
        let first_tiles: BTreeMap<String, u32> = first_tiles.rev().collect();
        let (mut tiles, mut unread) = (Vec::new(), Vec::new());
        let mut sets: BTreeMap<String, Vec<SetPicture>> = BTreeMap::new();
        for (file, name) in named {
            if name.tile.is_some() && name.tile.as_ref() != first_tiles.get(&name.set) {
                tiles.push(name_of(file));
            } else if name.readings.is_empty() {
                unread.push(name_of(file));
            } else {
                let set = sets.entry(name.set).or_default();
                let is_given = |channel: &str| {
                    let mut known = set.iter().flat_map(|picture| &picture.readings);
                    known.any(|known| known.channel == channel)
                };
                let new = name.readings.into_iter();
                let readings: Vec<ChannelReading> = new
                    .filter(|reading| !is_given(&reading.channel) && (!reading.needs_alpha || is_png_with_alpha(file)))
                    .collect();
                if !readings.is_empty() {
                    let file = file.clone();
                    set.push(SetPicture { file, readings });
                }
            }
        }
        for set in sets.values_mut() {
            set.sort_by_key(|picture| picture.readings.first().map(|reading| place_of(&reading.channel)));
        }
        let told = |files: Vec<String>, why: &str| (!files.is_empty()).then(|| format!("{}: {why}", files.join(", ")));
        let left_out = [
            told(
                tiles,
                "left out, since an Image reads one picture, and not the tiles of a UDIM layout",
            ),
            told(unread, "left out, since Combine material has no such channel"),
        ];
        Sets {
            sets,
            left_out: left_out.into_iter().flatten().collect(),
        }
    }
}

/// Returns the position of a channel among the images of a set. Rare channels come last.
fn place_of(channel: &str) -> usize {
    let usual = [
        "base_color",
        "roughness",
        "metallic",
        "occlusion",
        "height",
        "slope",
        "alpha",
        "emission",
    ];
    usual.iter().position(|known| *known == channel).unwrap_or(usual.len())
}

/// Returns whether a file is a PNG with alpha, by its header alone. Only PNG is checked, since the presets that pack a
/// channel into the alpha of an image that others write without alpha write PNG.
fn is_png_with_alpha(file: &Path) -> bool {
    // Signature, length and type of the first chunk, width, height, bit depth, and color type.
    const HEADER_BYTES: usize = 26;
    const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";
    const WITH_ALPHA: [u8; 2] = [4, 6];
    let mut header = [0; HEADER_BYTES];
    let is_read = file.is_file() && File::open(file).is_ok_and(|mut file| file.read_exact(&mut header).is_ok());
    is_read && header.starts_with(SIGNATURE) && WITH_ALPHA.contains(&header[HEADER_BYTES - 1])
}

fn name_of(file: &Path) -> String {
    let name = file.file_name().unwrap_or(file.as_os_str());
    name.to_string_lossy().into_owned()
}

fn stem_of(file: &Path) -> String {
    let stem = file.file_stem().unwrap_or(file.as_os_str());
    stem.to_string_lossy().into_owned()
}
