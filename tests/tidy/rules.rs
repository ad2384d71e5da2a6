//! The rules as tables: arrows, owners, sizes and words.

/// A crate, the crates of ours it may name, and the outside crates that it alone owns. An arrow that is not here is a
/// design change, not a detail: it changes ARCHITECTURE.md first.
pub(crate) const MAY_NAME: [(&str, &[&str], &[&str]); 20] = [
    ("sabi_cancel", &[], &[]),
    ("sabi_color", &[], &[]),
    ("sabi_curve", &[], &[]),
    ("sabi_files", &["sabi_cancel"], &["tempfile", "zip"]),
    ("sabi_graph", &[], &["petgraph"]),
    (
        "sabi_nodes",
        &["sabi_color", "sabi_curve", "sabi_files", "sabi_graph"],
        &["naga"],
    ),
    ("sabi_plan", &["sabi_graph", "sabi_nodes"], &[]),
    (
        "sabi_surface",
        &["sabi_cancel", "sabi_color", "sabi_files"],
        &[
            "draco_core",
            "gltf",
            "meshoptimizer_rs",
            "obvhs",
            "roxmltree",
            "ufbx",
            "uvunwrap",
        ],
    ),
    (
        "sabi_image",
        &["sabi_cancel", "sabi_color"],
        &["basisu", "exr", "image", "png", "ruzstd"],
    ),
    ("sabi_gpu", &["sabi_nodes", "sabi_plan", "sabi_surface"], &["wgpu"]),
    ("sabi_view", &["sabi_nodes", "sabi_surface", "sabi_gpu"], &[]),
    (
        "sabi_paint",
        &["sabi_color", "sabi_curve", "sabi_files", "sabi_surface", "sabi_image"],
        &[],
    ),
    (
        "sabi_export",
        &["sabi_color", "sabi_files", "sabi_surface", "sabi_image"],
        &[],
    ),
    (
        "sabi_engine",
        &[
            "sabi_cancel",
            "sabi_color",
            "sabi_files",
            "sabi_graph",
            "sabi_nodes",
            "sabi_plan",
            "sabi_surface",
            "sabi_image",
            "sabi_gpu",
            "sabi_view",
            "sabi_paint",
            "sabi_export",
        ],
        &["notify"],
    ),
    (
        "sabi_batch",
        &[
            "sabi_files",
            "sabi_graph",
            "sabi_surface",
            "sabi_gpu",
            "sabi_export",
            "sabi_engine",
        ],
        &["glob"],
    ),
    (
        "sabi_editing",
        &["sabi_files", "sabi_graph", "sabi_nodes", "sabi_paint", "sabi_engine"],
        &[],
    ),
    (
        "sabi_editor",
        &[
            "sabi_curve",
            "sabi_files",
            "sabi_graph",
            "sabi_nodes",
            "sabi_surface",
            "sabi_gpu",
            "sabi_view",
            "sabi_paint",
            "sabi_export",
            "sabi_engine",
            "sabi_editing",
        ],
        &[
            "eframe",
            "egui",
            "egui_phosphor",
            "egui_wgpu",
            "egui_commonmark",
            "egui_node_graph",
            "egui_tiles",
            "octotablet",
            "rfd",
            "wayland_client",
        ],
    ),
    (
        "sabi",
        &[
            "sabi_files",
            "sabi_graph",
            "sabi_surface",
            "sabi_gpu",
            "sabi_view",
            "sabi_export",
            "sabi_engine",
            "sabi_batch",
            "sabi_editor",
        ],
        &["clap", "indicatif"],
    ),
    ("xtask", &[], &[]),
    ("sabi_assets", &["xtask"], &[]),
];

/// Crates that know their flags or buttons: the front ends, their parts, and the chores, which have a command line of their
/// own.
pub(crate) const FRONT_ENDS: [&str; 4] = ["sabi_editor", "sabi", "xtask", "sabi_assets"];

/// Outside crates that a crate may name although another crate owns them: sabi_assets writes pictures of its own, and the
/// viewport draws with the device that kernels run on, which is the window's. Nodes of the canvas are laid out by what they read.
pub(crate) const ALSO: [(&str, &str); 4] = [
    ("sabi_assets", "png"),
    ("sabi_view", "wgpu"),
    ("sabi_editor", "wgpu"),
    ("sabi_editing", "petgraph"),
];

/// Outside crates with one owner. Anything else is free to use.
pub(crate) fn owned() -> impl Iterator<Item = &'static str> {
    MAY_NAME.iter().flat_map(|(_, _, outside)| outside.iter().copied())
}

/// Files that may be longer, each with its reason.
pub(crate) const LONGER_FILES: [(&str, &str); 0] = [];

pub(crate) const MOST_LINES_OF_A_FILE: usize = 800;
pub(crate) const MOST_BYTES_OF_A_GOLDEN: u64 = 8 * 1024;

/// Names that say nothing about what is inside.
pub(crate) const EMPTY_NAMES: [&str; 8] = [
    "util", "utils", "common", "helper", "helpers", "manager", "managers", "misc",
];

/// Left-overs that must not stay in a file, split so that this file does not find itself.
pub(crate) const LEFT_OVERS: [&str; 5] = [
    concat!("to", "do!("),
    concat!("db", "g!("),
    concat!("unimple", "mented!("),
    concat!("FIX", "ME"),
    concat!("XX", "X"),
];

/// Folders that exist on one machine only, split for the same reason.
pub(crate) const MACHINE_PATHS: [&str; 6] = [
    concat!("/wo", "rk/"),
    concat!("/t", "mp/"),
    concat!("/ho", "me/"),
    concat!("/ro", "ot/"),
    concat!("/Us", "ers/"),
    concat!("C:\\", "Users"),
];

/// Documents that are not in the repository, split for the same reason.
pub(crate) const ABSENT_DOCUMENTS: [&str; 3] = [
    concat!("DESIGN", " §"),
    concat!("DESIGN", ".md"),
    concat!("algorithms", ".md"),
];

/// Endings of files that people write and that are read as text.
pub(crate) const TEXT_ENDINGS: [&str; 9] = ["rs", "wgsl", "toml", "md", "sabi", "txt", "json", "yml", "sh"];
