//! The keys of a graph file. Reading, the order of writing, the treatment of unknown keys and the JSON schema all follow this table.

mod schema;
#[cfg(test)]
mod tests;
mod unknown_keys;

pub use schema::{FormatKey, FormatObject, format_objects, format_schema};
pub use unknown_keys::{UnknownKey, UnknownKeys, unknown_keys};

/// Object of a graph file whose keys are fixed.
#[derive(Debug)]
pub(crate) struct ObjectKeys {
    /// Name of the object in the schema and the documentation.
    pub(crate) name: &'static str,
    /// Description, a sentence.
    pub(crate) about: &'static str,
    /// Keys, in the order of writing.
    pub(crate) keys: &'static [ObjectKey],
}

/// Key of an object.
#[derive(Debug)]
pub(crate) struct ObjectKey {
    pub(crate) name: &'static str,
    pub(crate) value: ValueShape,
    pub(crate) is_needed: bool,
    /// Meaning, a sentence.
    pub(crate) about: &'static str,
}

/// Shape of a value.
#[derive(Debug)]
pub(crate) enum ValueShape {
    /// Exactly this text.
    Word(&'static str),
    /// One of these texts.
    Words(&'static [&'static str]),
    Text,
    Texts,
    /// `node.name`, or `node` for the first output of a node.
    Reference,
    /// `node.name`, any number of them.
    References,
    Flag,
    /// A whole number of 32 bits.
    Whole,
    /// Version of the format.
    Version,
    Number,
    /// This many numbers.
    Numbers(usize),
    /// Word or length that counts as 1.
    Fit,
    /// Value of a parameter.
    Any,
    /// Points of a curve.
    Curve,
    /// An object with fixed keys.
    Object(&'static ObjectKeys),
    /// Objects with fixed keys, by name.
    Objects(&'static ObjectKeys),
    /// Values of another shape, by name.
    Map(&'static ValueShape),
}

impl ObjectKeys {
    /// Returns true if the object has a key of that name.
    pub(crate) fn has(&self, name: &str) -> bool {
        self.keys.iter().any(|key| key.name == name)
    }
}

const fn key(name: &'static str, value: ValueShape, about: &'static str) -> ObjectKey {
    ObjectKey {
        name,
        value,
        is_needed: false,
        about,
    }
}

const fn needed(name: &'static str, value: ValueShape, about: &'static str) -> ObjectKey {
    ObjectKey {
        is_needed: true,
        ..key(name, value, about)
    }
}

const ABOUT: ObjectKey = key("about", ValueShape::Text, "What one sees, a sentence or two.");
const WORDS: ObjectKey = key(
    "words",
    ValueShape::Texts,
    "Words that it is found by, besides those of its name and text.",
);
const EXPOSED_KEY: ObjectKey = key(
    "exposed",
    ValueShape::Objects(&EXPOSED),
    "Knobs that it exposes, by name.",
);
const VARIANTS: ObjectKey = key(
    "variants",
    ValueShape::Map(&ValueShape::Map(&ValueShape::Any)),
    "Sets of values for its knobs, by name.",
);
const FRAMES: ObjectKey = key(
    "frames",
    ValueShape::Objects(&FRAME),
    "Titled boxes around nodes, by name.",
);
const NOTES: ObjectKey = key("notes", ValueShape::Objects(&NOTE), "Notes on the canvas, by name.");
const INPUTS: ObjectKey = key(
    "inputs",
    ValueShape::Objects(&INPUT),
    "Inputs, by name, where it is used as a group.",
);
const OUTPUTS: ObjectKey = key(
    "outputs",
    ValueShape::Map(&ValueShape::Reference),
    "Outputs of nodes, by the name of the group's output.",
);
const NODES: ObjectKey = needed("nodes", ValueShape::Objects(&NODE), "Nodes by id; may be empty.");
const FIT_WORDS: &str =
    "Length that counts as 1: \"unit\" (the model's largest side), \"metres\", \"piece\", or a number of meters.";

/// The file itself.
pub(crate) static DOCUMENT: ObjectKeys = ObjectKeys {
    name: "graph",
    about: "The whole file.",
    keys: &[
        needed("format", ValueShape::Word("sabi"), "Mark of a graph file."),
        needed(
            "version",
            ValueShape::Version,
            "Version of the format; older ones are read.",
        ),
        key("name", ValueShape::Text, "Display name."),
        ABOUT,
        WORDS,
        key(
            "preview",
            ValueShape::Object(&PREVIEW),
            "What the graph is shown on while it is edited.",
        ),
        key("fit", ValueShape::Fit, FIT_WORDS),
        key("seed", ValueShape::Whole, "Seed of the whole graph."),
        EXPOSED_KEY,
        VARIANTS,
        FRAMES,
        NOTES,
        key(
            "groups",
            ValueShape::Objects(&GROUP),
            "Groups that the file defines, by name.",
        ),
        INPUTS,
        OUTPUTS,
        NODES,
    ],
};

/// A group.
pub(crate) static GROUP: ObjectKeys = ObjectKeys {
    name: "group",
    about: "A graph that is used as a node.",
    keys: &[
        key(
            "name",
            ValueShape::Text,
            "Display name, where it is not that of the group.",
        ),
        ABOUT,
        WORDS,
        key(
            "library",
            ValueShape::Object(&LIBRARY),
            "Library file that it is a copy of.",
        ),
        key("fit", ValueShape::Fit, FIT_WORDS),
        EXPOSED_KEY,
        VARIANTS,
        FRAMES,
        NOTES,
        INPUTS,
        OUTPUTS,
        NODES,
    ],
};

/// A node.
pub(crate) static NODE: ObjectKeys = ObjectKeys {
    name: "node",
    about: "One step of a graph.",
    keys: &[
        needed(
            "kind",
            ValueShape::Text,
            "Kind, such as `noise/simplex`, or `graph/group` for an instance of a group.",
        ),
        key(
            "group",
            ValueShape::Text,
            "Group of an instance: its name, or the path of a graph file.",
        ),
        key("label", ValueShape::Text, "Display name."),
        key(
            "inputs",
            ValueShape::Map(&ValueShape::Reference),
            "Links, by input: `node` or `node.output`. An input that a parameter has as well is its mask.",
        ),
        key(
            "params",
            ValueShape::Map(&ValueShape::Any),
            "Parameters that were set, by name.",
        ),
        key("pos", ValueShape::Numbers(2), "Place on the canvas, in points."),
        key("muted", ValueShape::Flag, "Whether it passes its main input on."),
        key(
            "rows",
            ValueShape::Words(&["all", "wired", "none"]),
            "Rows that are drawn.",
        ),
        key("named_wires", ValueShape::Flag, "Whether its wires are drawn as names."),
    ],
};

/// A knob.
pub(crate) static EXPOSED: ObjectKeys = ObjectKeys {
    name: "exposed",
    about: "A knob that a graph or group exposes.",
    keys: &[
        key("to", ValueShape::References, "Parameters that it sets, `node.param`."),
        key(
            "curves",
            ValueShape::Map(&ValueShape::Curve),
            "Value of a parameter over that of the knob, by `node.param`: points [knob, parameter].",
        ),
        key("label", ValueShape::Text, "Display name."),
        key("about", ValueShape::Text, "Its effect, a sentence."),
        key("section", ValueShape::Text, "Title of the section that it stands in."),
        key("order", ValueShape::Whole, "Place among the exposed knobs."),
        key("range", ValueShape::Numbers(2), "Lowest and highest number taken."),
        key("default", ValueShape::Any, "Value until it is set."),
    ],
};

/// An input of a group.
pub(crate) static INPUT: ObjectKeys = ObjectKeys {
    name: "input",
    about: "An input of a group.",
    keys: &[
        key(
            "to",
            ValueShape::References,
            "Inputs of nodes that it feeds, `node.input`.",
        ),
        key(
            "type",
            ValueShape::Words(&["mask", "color", "vector", "material"]),
            "Type of its values.",
        ),
        key("label", ValueShape::Text, "Display name."),
    ],
};

/// A frame.
pub(crate) static FRAME: ObjectKeys = ObjectKeys {
    name: "frame",
    about: "A titled box around nodes.",
    keys: &[
        key("title", ValueShape::Text, "Title."),
        key("color", ValueShape::Text, "Color, `#rrggbb`."),
        key("nodes", ValueShape::Texts, "Ids of the nodes in it."),
    ],
};

/// A note.
pub(crate) static NOTE: ObjectKeys = ObjectKeys {
    name: "note",
    about: "A note on the canvas.",
    keys: &[
        needed("text", ValueShape::Text, "Its text."),
        key("pos", ValueShape::Numbers(2), "Place on the canvas, in points."),
        key("width", ValueShape::Number, "Width, in points."),
        key("color", ValueShape::Text, "Color, `#rrggbb`."),
    ],
};

/// The preview.
pub(crate) static PREVIEW: ObjectKeys = ObjectKeys {
    name: "preview",
    about: "What a graph is shown on while it is edited. Bakes read of it alone how its model is read.",
    keys: &[
        key(
            "mesh",
            ValueShape::Text,
            "Model, relative to the graph file; `builtin:NAME` for one that comes with the program, such as `builtin:crate`.",
        ),
        key(
            "textures",
            ValueShape::Text,
            "Folder in which, and below which, files are looked for that the model names and that are not there, relative to the graph file.",
        ),
        key(
            "parts",
            ValueShape::Texts,
            "Names of the parts of the model that are taken; without it all but hulls and coarser levels of detail.",
        ),
        key(
            "without",
            ValueShape::Texts,
            "Names of the parts of the model that are left out.",
        ),
        key(
            "turn_faces",
            ValueShape::Flag,
            "True to turn faces of the model that are inside out.",
        ),
        key("size", ValueShape::Whole, "Texels along a side."),
        key("variant", ValueShape::Text, "Variant that is shown."),
        key(
            "views",
            ValueShape::Objects(&VIEW),
            "Views of the model that were kept, by name.",
        ),
    ],
};

/// A view.
pub(crate) static VIEW: ObjectKeys = ObjectKeys {
    name: "view",
    about: "A view of the model. Lengths are shares of its largest side.",
    keys: &[
        key(
            "target",
            ValueShape::Numbers(3),
            "Point that is looked at, from the middle of the model.",
        ),
        key(
            "yaw",
            ValueShape::Number,
            "Side that is seen, degrees: 0 the front, 90 the right.",
        ),
        key("pitch", ValueShape::Number, "Elevation, degrees: 90 is from above."),
        key("distance", ValueShape::Number, "Distance from the target."),
        key(
            "parallel",
            ValueShape::Flag,
            "Whether it is seen through a parallel lens.",
        ),
    ],
};

/// The origin of a library group.
pub(crate) static LIBRARY: ObjectKeys = ObjectKeys {
    name: "library",
    about: "Library file that a group is a copy of.",
    keys: &[
        needed(
            "file",
            ValueShape::Text,
            "Path in the library, or relative to the graph file.",
        ),
        needed(
            "digest",
            ValueShape::Text,
            "BLAKE3 of the file that was copied, in hexadecimal.",
        ),
    ],
};

/// All objects with fixed keys.
pub(crate) static OBJECTS: [&ObjectKeys; 10] = [
    &DOCUMENT, &GROUP, &NODE, &EXPOSED, &INPUT, &FRAME, &NOTE, &PREVIEW, &VIEW, &LIBRARY,
];
