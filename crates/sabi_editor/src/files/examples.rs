//! Built-in graphs and models. They are written to a folder of the artist before they are opened, so that edits do not
//! change the built-in ones.

use std::io;
use std::path::{Path, PathBuf};

use sabi_engine::{free_graph_file, write_whole};

/// Built-in example: its title, file and model.
pub(crate) struct Example {
    pub(crate) title: &'static str,
    pub(crate) says: &'static str,
    name: &'static str,
    text: &'static str,
    /// Picture of it on its model, PNG.
    pub(crate) picture: &'static [u8],
}

macro_rules! picture {
    ($name:literal) => {
        include_bytes!(concat!("../../../../docs/pictures/", $name)).as_slice()
    };
}

macro_rules! graph {
    ($name:literal) => {
        include_str!(concat!("../../../../graphs/", $name))
    };
}

/// All examples.
pub(crate) const EXAMPLES: [Example; 6] = [
    Example {
        title: "Weathered bench",
        says: "Paint that peels off a bench, with rust and dirt below",
        name: "weathered-bench.sabi",
        text: graph!("weathered-bench.sabi"),
        picture: picture!("weathered-bench-bench.png"),
    },
    Example {
        title: "Rusty metal",
        says: "Bare metal that rusts from its edges and runs down in stains",
        name: "rusty-metal.sabi",
        text: graph!("rusty-metal.sabi"),
        picture: picture!("rusty-metal-barrel.png"),
    },
    Example {
        title: "Weathered paint",
        says: "Layers of paint that chip and fade",
        name: "weathered-paint.sabi",
        text: graph!("weathered-paint.sabi"),
        picture: picture!("weathered-paint-crate.png"),
    },
    Example {
        title: "Old stone",
        says: "Stone with cracks, moss and damp",
        name: "old-stone.sabi",
        text: graph!("old-stone.sabi"),
        picture: picture!("old-stone-column.png"),
    },
    Example {
        title: "Varnished wood",
        says: "Wood whose varnish wears off where it is touched",
        name: "varnished-wood.sabi",
        text: graph!("varnished-wood.sabi"),
        picture: picture!("varnished-wood-table.png"),
    },
    Example {
        title: "Mossy figure",
        says: "Moss that grows where it is damp and sheltered",
        name: "mossy-figure.sabi",
        text: graph!("mossy-figure.sabi"),
        picture: picture!("mossy-figure-figure.png"),
    },
];

macro_rules! models {
    ($($name:literal)*) => {
        [$(($name, include_bytes!(concat!("../../../../assets/meshes/", $name)).as_slice()),)*]
    };
}

/// Models of the examples.
const MODELS: [(&str, &[u8]); 7] =
    models!["bench.glb" "chain.glb" "crate.glb" "table.glb" "column.glb" "figure.glb" "sphere.glb"];

/// Folders of graphs and models in the folder of examples, as in the project.
const GRAPHS: &str = "graphs";
const MESHES: &str = "assets/meshes";

/// Writes an example with all models into a folder. Returns its file. Existing files stay, also edited ones: beside an
/// edited graph the example is written under the next free name.
pub(crate) fn unpack(folder: &Path, at: usize) -> io::Result<Option<PathBuf>> {
    let Some(example) = EXAMPLES.get(at) else {
        return Ok(None);
    };
    for (name, bytes) in MODELS {
        write_where_none(&folder.join(MESHES).join(name), bytes)?;
    }
    let (stem, text) = (example.name.trim_end_matches(".sabi"), example.text.as_bytes());
    let file = free_graph_file(&folder.join(GRAPHS), stem, text).ok_or(io::ErrorKind::AlreadyExists)?;
    write_where_none(&file, text)?;
    Ok(Some(file))
}

/// File of the built-in model that new graphs are shown on, written if it is missing.
pub(crate) fn first_model(folder: &Path) -> io::Result<PathBuf> {
    let [(name, bytes), ..] = MODELS;
    let file = folder.join(MESHES).join(name);
    write_where_none(&file, bytes)?;
    Ok(file)
}

/// An existing file may have been edited, and is not replaced.
fn write_where_none(file: &Path, bytes: &[u8]) -> io::Result<()> {
    if file.exists() {
        return Ok(());
    }
    write_whole(file, bytes).map_err(|error| error.source)
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn every_example_finds_its_model_where_it_is_unpacked() {
        let folder = tempfile::tempdir().expect("a folder");
        for (at, example) in EXAMPLES.iter().enumerate() {
            let file = unpack(folder.path(), at).expect("written").expect("an example");
            let open = sabi_engine::OpenGraph::open(&file).expect("a graph");
            let mesh = open.document.preview.as_ref().and_then(|preview| preview.mesh.clone());
            let mesh = mesh.unwrap_or_else(|| panic!("{} names a model", example.name));
            assert!(open.folder().join(&mesh).is_file(), "{}: {mesh}", example.name);
        }
    }

    #[test]
    fn an_example_that_was_worked_on_is_not_written_over() {
        let folder = tempfile::tempdir().expect("a folder");
        let open = || unpack(folder.path(), 0).expect("written").expect("an example");
        let first = open();
        assert_eq!(open(), first, "nobody worked on it");
        fs::write(&first, "mine").expect("a file");
        let model = folder.path().join(MESHES).join(MODELS[0].0);
        fs::write(&model, "mine").expect("a file");
        let second = open();
        assert_ne!(second, first);
        assert_eq!(first_model(folder.path()).expect("a model"), model);
        assert_eq!(fs::read_to_string(&model).expect("a file"), "mine");
        assert_eq!(fs::read_to_string(&first).expect("a file"), "mine");
        assert_eq!(fs::read_to_string(&second).expect("a file"), EXAMPLES[0].text);
    }
}
