//! Small pictures of what was saved: variants, and groups in libraries. They lie in the cache folder, so that files stay
//! text; where one is gone, nothing but the picture is.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_engine::view::Pixels;
use sabi_engine::{find_thumbnail, keep_thumbnail, thumbnail_of};

/// What a picture is of: a file, and something in it. Of a graph that has no file yet, the file is empty.
type Of = (PathBuf, String);

/// Small pictures of what was saved.
#[derive(Default)]
pub(crate) struct Keepsakes {
    cache: Option<PathBuf>,
    /// What was looked for already, also where there is nothing.
    known: BTreeMap<Of, Option<(TextureHandle, Pixels)>>,
}

impl Keepsakes {
    /// Pictures in a cache folder; without one they last as long as the window.
    pub(crate) fn new(cache: Option<PathBuf>) -> Keepsakes {
        Keepsakes {
            cache,
            known: BTreeMap::new(),
        }
    }

    /// Keeps a picture of something in a file.
    pub(crate) fn keep(&mut self, context: &Context, file: &Path, what: &str, picture: &Pixels) -> Result<(), String> {
        let small = thumbnail_of(picture);
        let texture = loaded(context, what, &small);
        let kept = self.put_away(file, what, &small);
        self.known
            .insert((file.to_owned(), what.to_owned()), Some((texture, small)));
        kept
    }

    fn put_away(&self, file: &Path, what: &str, small: &Pixels) -> Result<(), String> {
        match &self.cache {
            // What has no file would be found by everything that has none.
            Some(cache) if !file.as_os_str().is_empty() => {
                keep_thumbnail(cache, &[&file.to_string_lossy(), what], small).map_err(|error| error.to_string())
            }
            _ => Ok(()),
        }
    }

    /// The picture of something in a file, if one was kept.
    pub(crate) fn find(&mut self, context: &Context, file: &Path, what: &str) -> Option<TextureId> {
        let of = (file.to_owned(), what.to_owned());
        let cache = self.cache.as_deref().filter(|_| !file.as_os_str().is_empty());
        let found = self.known.entry(of).or_insert_with(|| {
            let small = find_thumbnail(cache?, &[&file.to_string_lossy(), what])?;
            Some((loaded(context, what, &small), small))
        });
        found.as_ref().map(|(texture, _)| texture.id())
    }

    /// What was in one file is in another one from now on as well, since it was saved there.
    pub(crate) fn follow(&mut self, from: &Path, to: &Path) -> Result<(), String> {
        if from == to {
            return Ok(());
        }
        let is_of = |(of, kept): &(&Of, &Option<(TextureHandle, Pixels)>)| of.0 == from && kept.is_some();
        let moved: Vec<_> = self.known.iter().filter(is_of).collect();
        let moved: Vec<_> = moved
            .into_iter()
            .map(|((_, what), kept)| (what.clone(), kept.clone()))
            .collect();
        let mut told = Ok(());
        for (what, kept) in moved {
            if let Some((_, small)) = &kept {
                told = told.and(self.put_away(to, &what, small));
            }
            self.known.insert((to.to_owned(), what), kept);
        }
        told
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
        let mut kept = Keepsakes::new(Some(cache.path().to_owned()));
        assert_eq!(kept.find(&context, file, "heavy"), None);
        kept.keep(&context, file, "heavy", &gray()).expect("kept");
        let mut again = Keepsakes::new(Some(cache.path().to_owned()));
        assert!(again.find(&context, file, "heavy").is_some());
        assert_eq!(again.find(&context, file, "light"), None);
        assert_eq!(again.find(&context, Path::new("other.sabi"), "heavy"), None);
    }

    #[test]
    fn pictures_of_a_graph_without_a_file_are_nobody_elses_and_follow_it_to_its_first_one() {
        let cache = tempfile::tempdir().expect("a folder");
        let context = Context::default();
        let untitled = Path::new("");
        let mut kept = Keepsakes::new(Some(cache.path().to_owned()));
        kept.keep(&context, untitled, "heavy", &gray()).expect("kept");
        assert!(kept.find(&context, untitled, "heavy").is_some());
        let mut other = Keepsakes::new(Some(cache.path().to_owned()));
        assert_eq!(other.find(&context, untitled, "heavy"), None);
        kept.follow(untitled, Path::new("worn.sabi")).expect("kept");
        assert!(other.find(&context, Path::new("worn.sabi"), "heavy").is_some());
    }
}
