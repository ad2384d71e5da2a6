//! Built-in graphs and models. They are written to a folder of the artist before they are opened, so that edits do not
//! change the built-in ones.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use sabi_engine::effect_library::effect_library;
use sabi_engine::session::free_graph_file;
use sabi_files::write_whole;

use crate::builtin_models::{MESHES, MODELS};

/// Built-in example: its title, file and model.
pub(crate) struct Example {
    pub(crate) title: &'static str,
    pub(crate) says: &'static str,
    name: &'static str,
    text: &'static str,
    /// Picture of it on its model, PNG.
    pub(crate) picture: &'static [u8],
}

macro_rules! example {
    ($title:literal, $says:literal, $name:literal) => {
        Example {
            title: $title,
            says: $says,
            name: concat!($name, ".sabi"),
            text: include_str!(concat!("../../../../graphs/examples/", $name, ".sabi")),
            picture: include_bytes!(concat!("../../../../docs/pictures/", $name, ".png")).as_slice(),
        }
    };
}

/// All examples.
pub(crate) const EXAMPLES: [Example; 8] = [
    example!(
        "Army paint",
        "Olive paint of a crate that was used, chipped and left in the dust",
        "army-paint"
    ),
    example!(
        "Bronze statue",
        "Dark bronze with verdigris in its hollows and polish where hands reach",
        "bronze-statue"
    ),
    example!(
        "Machine paint",
        "Enamel of a machine, chipped to primer and steel, with oil and dust",
        "machine-paint"
    ),
    example!(
        "Porcelain",
        "White glaze that pools, crackles and has lost some chips",
        "porcelain"
    ),
    example!(
        "Worn oak",
        "Oak whose varnish is worn off where it is touched",
        "worn-oak"
    ),
    example!(
        "Brick wall",
        "Plaster that has fallen off the bricks of a wall",
        "brick-wall"
    ),
    example!(
        "Concrete",
        "Concrete cast in boards, stained by rain and damp at the foot",
        "concrete"
    ),
    example!(
        "Leather",
        "Leather that is rubbed pale at its edges and dark in its folds",
        "leather"
    ),
];

/// Folders of graphs and groups in the folder of examples, as in the project.
const GRAPHS: &str = "graphs/examples";
/// Name of the folder of examples of every user.
pub(crate) const EXAMPLES_FOLDER: &str = "examples";
const LIBRARY: &str = "graphs/library";
/// File that makes the folder of examples a project, whose graphs may open all files in it.
const MARK: &str = "sabi.toml";
const MARK_TEXT: &[u8] = b"# Graphs below this folder may open all files below it.\n";

/// Writes an example with all models into a folder. Returns its file. Existing files stay, also edited ones: beside an
/// edited graph the example is written under the next free name.
pub(crate) fn unpack(folder: &Path, at: usize) -> io::Result<Option<PathBuf>> {
    let Some(example) = EXAMPLES.get(at) else {
        return Ok(None);
    };
    for (name, bytes) in MODELS {
        write_where_none(&folder.join(MESHES).join(name), bytes)?;
    }
    unpack_library(folder)?;
    write_where_none(&folder.join(MARK), MARK_TEXT)?;
    let (stem, text) = (example.name.trim_end_matches(".sabi"), example.text.as_bytes());
    let file = free_graph_file(&folder.join(GRAPHS), stem, text).ok_or(io::ErrorKind::AlreadyExists)?;
    write_where_none(&file, text)?;
    Ok(Some(file))
}

/// Writes the groups that examples use, beside them as in the project.
fn unpack_library(folder: &Path) -> io::Result<()> {
    let library = effect_library(&folder.join("effects")).map_err(io::Error::other)?;
    for category in fs::read_dir(&library)? {
        let category = category?;
        let into = folder.join(LIBRARY).join(category.file_name());
        for file in fs::read_dir(category.path())? {
            let file = file?;
            write_where_none(&into.join(file.file_name()), &fs::read(file.path())?)?;
        }
    }
    Ok(())
}

/// File of the built-in model that new graphs are shown on, written if it is missing.
pub(crate) fn first_model(folder: &Path) -> io::Result<PathBuf> {
    let [(name, bytes), ..] = MODELS;
    let file = folder.join(MESHES).join(name);
    write_where_none(&file, bytes)?;
    Ok(file)
}

/// Files of all built-in models, whether they were written or not.
pub(crate) fn models(folder: &Path) -> impl Iterator<Item = PathBuf> {
    let folder = folder.join(MESHES);
    MODELS.iter().map(move |(name, _)| folder.join(name))
}

/// Folder of the built-in models.
pub(crate) fn models_folder(folder: &Path) -> Option<PathBuf> {
    models(folder).next()?.parent().map(Path::to_owned)
}

/// Returns whether a file is a built-in model, of any computer or user.
pub(crate) fn is_own_model(file: &Path) -> bool {
    MODELS.iter().any(|(name, _)| is_named(file, name))
}

fn is_named(file: &Path, name: &str) -> bool {
    file.ends_with(Path::new(EXAMPLES_FOLDER).join(MESHES).join(name))
}

/// File of a model that a graph names. If that is missing and is a built-in model of another computer or user, the file
/// of the same model in `folder`, which is written if it is missing, too.
pub(crate) fn at_home(folder: Option<&Path>, file: PathBuf) -> PathBuf {
    let Some(folder) = folder.filter(|_| !file.exists()) else {
        return file;
    };
    let is_same = |(name, _): &(&str, &[u8])| is_named(&file, name) || file == folder.join(MESHES).join(name);
    let Some((name, bytes)) = MODELS.into_iter().find(is_same) else {
        return file;
    };
    let own = folder.join(MESHES).join(name);
    match write_where_none(&own, bytes) {
        Ok(()) => own,
        // The missing model is reported when it is read.
        Err(_) => file,
    }
}

/// Writes a built-in model if it is missing; nothing for other files.
pub(crate) fn write_model(folder: &Path, file: &Path) -> io::Result<()> {
    let known = models(folder).zip(MODELS).find(|(known, _)| known == file);
    known.map_or(Ok(()), |(file, (_, bytes))| write_where_none(&file, bytes))
}

/// Writes a file unless it exists: an existing one may have been edited.
fn write_where_none(file: &Path, bytes: &[u8]) -> io::Result<()> {
    if file.exists() {
        return Ok(());
    }
    write_whole(file, bytes).map_err(|error| error.source)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin_models::{builtin_file, builtin_name};

    #[test]
    fn a_built_in_model_is_known_by_its_place_among_the_examples() {
        let folder = Path::new("home").join(EXAMPLES_FOLDER);
        assert!(models(&folder).all(|model| is_own_model(&model)));
        for other in ["cube.glb", "examples/cube.glb", "examples/assets/meshes/mine.glb"] {
            assert!(!is_own_model(Path::new(other)), "{other}");
        }
    }

    #[test]
    fn every_example_finds_its_model_where_it_is_unpacked() {
        let folder = tempfile::tempdir().expect("a folder");
        for (at, example) in EXAMPLES.iter().enumerate() {
            let file = unpack(folder.path(), at).expect("written").expect("an example");
            let open = sabi_engine::OpenGraph::open(&file).expect("a graph");
            let mesh = open.document.preview.as_ref().and_then(|preview| preview.mesh.clone());
            let mesh = mesh.unwrap_or_else(|| panic!("{} names a model", example.name));
            let found = open.trusted.check(&open.base(), &mesh);
            assert!(found.is_ok_and(|file| file.is_file()), "{}: {mesh}", example.name);
            open.flatten(&sabi_graph::Overrides::default())
                .expect("its groups may be opened");
        }
    }

    #[test]
    fn a_built_in_model_of_another_computer_is_found_among_the_examples_here() {
        let folder = tempfile::tempdir().expect("a folder");
        let home = |path: &str| at_home(Some(folder.path()), PathBuf::from(path));
        let own = folder.path().join("assets/meshes/crate.glb");
        let theirs = "/elsewhere/ann/.config/sabi/examples/assets/meshes/crate.glb";
        assert_eq!(home(theirs), own);
        assert!(own.is_file());
        for other in [
            "/elsewhere/ann/crate.glb",
            "/elsewhere/ann/examples/assets/meshes/hero.glb",
        ] {
            assert_eq!(home(other), Path::new(other));
        }
    }

    #[test]
    fn a_built_in_model_has_a_name_that_is_found_in_any_folder_until_it_is_changed() {
        let [here, there] = [(); 2].map(|()| tempfile::tempdir().expect("a folder"));
        for (file, _) in MODELS {
            let own = here.path().join(MESHES).join(file);
            assert_eq!(builtin_name(here.path(), &own), None, "{file} is not written yet");
            write_model(here.path(), &own).expect("written");
            let name = builtin_name(here.path(), &own).expect("a name");
            let other = builtin_file(there.path(), &name).expect("a file");
            assert_eq!(other, there.path().join(MESHES).join(file));
            assert_eq!(at_home(Some(there.path()), other.clone()), other);
            assert!(other.is_file(), "{file} is written when it is needed");
            fs::write(&own, "mine").expect("a file");
            assert_eq!(builtin_name(here.path(), &own), None, "{file} was changed");
        }
        assert_eq!(builtin_file(here.path(), "hero"), None);
        assert_eq!(builtin_name(here.path(), &here.path().join("crate.glb")), None);
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
