//! A graph file as data: the main graph, its groups and their exposed knobs and ports.

use std::collections::BTreeMap;

use crate::{GROUP_KIND, Graph, NodeId, OutputRef, PortType, SlotRef, Value};

/// A graph file.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Document {
    /// Display name; empty when the file has none.
    pub name: String,
    /// Description and search words, for artists.
    pub description: Description,
    /// Model and size to show the graph on while editing.
    pub preview: Option<Preview>,
    /// Length on the model that counts as 1 in this graph.
    pub fit: Fit,
    /// Seed of the whole document; 0 unless the file says otherwise.
    pub seed: u32,
    /// The main graph.
    pub graph: Graph,
    /// Groups defined in this file, by name.
    pub groups: BTreeMap<String, GroupDef>,
    /// Inputs of the main graph when another file uses this one as a group.
    pub inputs: BTreeMap<String, GroupInput>,
    /// Outputs of the main graph when another file uses this one as a group.
    pub outputs: BTreeMap<String, OutputRef>,
    /// Top-level keys that this version does not know, kept as they are.
    pub extra: BTreeMap<String, Value>,
}

impl Document {
    /// Returns a copy of this document in which these nodes of its main graph have another kind.
    pub fn with_kind<'a>(&self, nodes: impl IntoIterator<Item = &'a NodeId>, kind: &str) -> Document {
        let mut document = self.clone();
        for id in nodes {
            if let Ok(node) = document.graph.node_mut(id) {
                node.kind = kind.to_owned();
            }
        }
        document
    }

    /// Returns a copy of this document whose group instances use other groups. `name` maps a group or group file to its new
    /// name; `None` keeps it.
    pub fn with_group_names(&self, name: impl Fn(&str) -> Option<String>) -> Document {
        let mut document = self.clone();
        let inner = document.groups.values_mut().map(|group| &mut group.graph);
        for graph in std::iter::once(&mut document.graph).chain(inner) {
            for (_, node) in graph.net.node_weights_mut() {
                let other = node
                    .group
                    .as_deref()
                    .filter(|_| node.kind == GROUP_KIND)
                    .and_then(&name);
                if let Some(other) = other {
                    node.group = Some(other);
                }
            }
        }
        document
    }

    /// Creates an empty document with this name.
    pub fn new(name: impl Into<String>) -> Self {
        Document {
            name: name.into(),
            ..Document::default()
        }
    }
}

/// Description of a graph that other graphs use, for artists.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Description {
    /// Description of the visible result, in one or two sentences.
    pub about: Option<String>,
    /// Additional search words, besides the words of the name and of the description.
    pub words: Vec<String>,
}

/// Library file that a group is a copy of.
#[derive(Clone, Debug, PartialEq)]
pub struct LibrarySource {
    /// The file: a path inside the library, such as `weathering/rust.sabi`, or one relative to the document.
    pub file: String,
    /// Digest of the file that the copy was made of, blake3 in hexadecimal.
    pub digest: String,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

/// Settings of the preview in the editor.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Preview {
    /// The model, as a path relative to the graph file, or [`Preview::BUILTIN`] with the name of one that comes with the program.
    pub mesh: Option<String>,
    /// Folder in which files are looked for that the model names and that are not there, as a path relative to the graph file.
    pub textures: Option<String>,
    /// Names of the parts of the model to use. If empty, all parts but collision hulls and coarser levels of detail are used.
    pub parts: Vec<String>,
    /// Names of the parts of the model that are left out.
    pub without: Vec<String>,
    /// True to turn faces of the model that are inside out.
    pub turn_faces: bool,
    /// Side of the preview's textures in texels.
    pub size: Option<u32>,
    /// Variant of the main graph that is shown; `None` shows the graph's own values.
    pub variant: Option<String>,
    /// Saved views of the model, by name.
    pub views: BTreeMap<String, SavedView>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

impl Preview {
    /// Beginning of the name of a model that comes with the program.
    pub const BUILTIN: &str = "builtin:";

    /// Name of the model that comes with the program; `None` if the model is a file, and without a model.
    pub fn builtin_mesh(&self) -> Option<&str> {
        self.mesh.as_deref()?.strip_prefix(Preview::BUILTIN)
    }
}

/// A view of the model. Lengths are shares of the model's largest side.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SavedView {
    /// Point that the view is centered on, relative to the middle of the model.
    pub target: [f64; 3],
    /// Side of the model that faces the viewer, in degrees: 0 is the front, 90 the right.
    pub yaw: f64,
    /// Elevation, degrees: 90 is from above.
    pub pitch: f64,
    /// Distance from the target.
    pub distance: f64,
    /// True for a parallel projection.
    pub is_parallel: bool,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

impl SavedView {
    /// Distance at which the whole model is visible, whatever its shape.
    pub const FAR: f64 = 3.5;
}

/// Length on the model that counts as 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Fit {
    /// The model's largest side.
    #[default]
    Unit,
    /// One meter.
    Metres,
    /// This many meters; above zero.
    Length(f64),
    /// The size of the piece that a surface point belongs to, so that small and large pieces age alike.
    Piece,
}

/// A group: a graph that other graphs use as one node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupDef {
    /// Display name, where it differs from the key in [`Document::groups`].
    pub name: Option<String>,
    /// Description and search words, for artists.
    pub description: Description,
    /// Library file that the group is a copy of, while it is linked to that file.
    pub library: Option<LibrarySource>,
    /// Fit that the lengths of the group were made for; `None` means the document's fit.
    pub fit: Option<Fit>,
    /// Its nodes, knobs, variants and frames.
    pub graph: Graph,
    /// Its inputs, by name.
    pub inputs: BTreeMap<String, GroupInput>,
    /// Its outputs, by name.
    pub outputs: BTreeMap<String, OutputRef>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}

/// An input of a group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct GroupInput {
    /// Inputs of inner nodes that this input feeds, written `node.input`.
    pub to: Vec<SlotRef>,
    /// Port type, where the file has one.
    pub ty: Option<PortType>,
    /// Name shown to artists.
    pub label: Option<String>,
    /// Keys that this version does not know.
    pub extra: BTreeMap<String, Value>,
}
