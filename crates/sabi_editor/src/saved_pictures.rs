//! Small pictures of saved graphs, variants and library groups. They are in the cache folder, so that graph files stay
//! text; if one is deleted, only the picture is lost.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_engine::evaluating::{load_thumbnail, store_thumbnail, thumbnail_of};
use sabi_files::stored_path;
use sabi_view::Pixels;

/// Name of the picture of a group in a library file.
pub(crate) const OF_GROUP: &str = "group";

/// Name of the picture of a graph, as it was saved last.
pub(crate) const OF_GRAPH: &str = "graph";

/// Subject of a picture: a file, and a name in it. The file of a graph that was never saved is empty.
type PictureSubject = (PathBuf, String);
type LoadedPicture = (TextureHandle, Pixels);

/// Small pictures of saved variants and library groups.
#[derive(Default)]
pub(crate) struct SavedPictures {
    cache: Option<PathBuf>,
    /// Pictures that were looked for, with `None` where there is none. Filled while views read, hence the cell.
    known: RefCell<BTreeMap<PictureSubject, Option<LoadedPicture>>>,
}

impl SavedPictures {
    /// Pictures in a cache folder; without one they are lost with the window.
    pub(crate) fn new(cache: Option<PathBuf>) -> SavedPictures {
        SavedPictures {
            cache,
            known: RefCell::default(),
        }
    }

    /// Stores a picture, and shows it even if it cannot be written.
    ///
    /// # Errors
    /// It cannot be written to the cache; the error is a sentence.
    pub(crate) fn store(&mut self, context: &Context, file: &Path, what: &str, picture: &Pixels) -> Result<(), String> {
        let small = thumbnail_of(picture);
        let texture = loaded(context, what, &small);
        let written = self.write(file, what, &small);
        self.known
            .get_mut()
            .insert((file.to_owned(), what.to_owned()), Some((texture, small)));
        written
    }

    fn write(&self, file: &Path, what: &str, small: &Pixels) -> Result<(), String> {
        match &self.cache {
            // Without a file, every unsaved graph would find it.
            Some(cache) if !file.as_os_str().is_empty() => {
                store_thumbnail(cache, &[&stored_path(file), what], small).map_err(|error| error.to_string())
            }
            _ => Ok(()),
        }
    }

    /// Texture of a stored picture, if there is one.
    pub(crate) fn find(&self, context: &Context, file: &Path, what: &str) -> Option<TextureId> {
        let of = (file.to_owned(), what.to_owned());
        let cache = self.cache.as_deref().filter(|_| !file.as_os_str().is_empty());
        let mut known = self.known.borrow_mut();
        let found = known.entry(of).or_insert_with(|| {
            let small = load_thumbnail(cache?, &[&stored_path(file), what])?;
            Some((loaded(context, what, &small), small))
        });
        found.as_ref().map(|(texture, _)| texture.id())
    }

    /// Stores the pictures of one file for another file as well, to which the graph was saved.
    ///
    /// # Errors
    /// A sentence, where one cannot be written to the cache.
    pub(crate) fn copy(&mut self, from: &Path, to: &Path) -> Result<(), String> {
        if from == to {
            return Ok(());
        }
        let known = self.known.get_mut().iter();
        let copied = known.filter_map(|((file, what), picture)| Some((file, what, picture.as_ref()?)));
        let copied: Vec<(String, LoadedPicture)> = copied
            .filter(|(file, ..)| *file == from)
            .map(|(_, what, picture)| (what.clone(), picture.clone()))
            .collect();
        let mut written = Ok(());
        for (what, picture) in copied {
            written = written.and(self.write(to, &what, &picture.1));
            self.known.get_mut().insert((to.to_owned(), what), Some(picture));
        }
        written
    }
}

fn loaded(context: &Context, name: &str, picture: &Pixels) -> TextureHandle {
    let image = ColorImage::from_rgba_unmultiplied(picture.size.map(|side| side as usize), &picture.rgba);
    context.load_texture(name, image, TextureOptions::LINEAR)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray() -> Pixels {
        Pixels {
            size: [2, 2],
            rgba: vec![128; 16],
        }
    }

    #[test]
    fn a_picture_is_found_again_by_another_window() {
        let cache = tempfile::tempdir().expect("a folder");
        let context = Context::default();
        let file = Path::new("worn.sabi");
        let mut kept = SavedPictures::new(Some(cache.path().to_owned()));
        assert_eq!(kept.find(&context, file, "heavy"), None);
        kept.store(&context, file, "heavy", &gray()).expect("kept");
        let again = SavedPictures::new(Some(cache.path().to_owned()));
        assert!(again.find(&context, file, "heavy").is_some());
        assert_eq!(again.find(&context, file, "light"), None);
        assert_eq!(again.find(&context, Path::new("other.sabi"), "heavy"), None);
    }

    #[test]
    fn pictures_of_an_unsaved_graph_are_its_own_and_are_copied_to_its_first_file() {
        let cache = tempfile::tempdir().expect("a folder");
        let context = Context::default();
        let untitled = Path::new("");
        let mut kept = SavedPictures::new(Some(cache.path().to_owned()));
        kept.store(&context, untitled, "heavy", &gray()).expect("kept");
        assert!(kept.find(&context, untitled, "heavy").is_some());
        let other = SavedPictures::new(Some(cache.path().to_owned()));
        assert_eq!(other.find(&context, untitled, "heavy"), None);
        kept.copy(untitled, Path::new("worn.sabi")).expect("kept");
        assert!(other.find(&context, Path::new("worn.sabi"), "heavy").is_some());
    }
}
