//! Small pictures of the effects of built-in nodes and groups, loaded on a thread of their own when they are scrolled
//! into view.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_engine::catalog::picture_of;
use sabi_engine::effect_library::group_picture;

use crate::task::Task;

/// Size of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum PictureSize {
    /// In a list.
    Small,
    /// Beside the list.
    Large,
}

impl PictureSize {
    fn pixels(self) -> u32 {
        match self {
            PictureSize::Small => 72,
            PictureSize::Large => 256,
        }
    }
}

/// Pictures that were read, with the kind or file of a group and the size that each was asked for.
type ReadPictures = Vec<((String, PictureSize), ColorImage)>;

/// Small pictures of the effects of built-in nodes, by id, and of groups of the effect library, by file.
#[derive(Default)]
pub(super) struct EntryPictures {
    coming: Option<Task<ReadPictures>>,
    textures: BTreeMap<(String, PictureSize), TextureHandle>,
    /// Kinds whose pictures were asked for. Filled while entries are drawn, hence the cell.
    wanted: RefCell<BTreeSet<(String, PictureSize)>>,
    /// Kinds whose loading was started.
    started: BTreeSet<(String, PictureSize)>,
}

impl EntryPictures {
    /// Takes over the pictures that are loaded, and starts loading those that were asked for since.
    pub(super) fn poll(&mut self, context: &Context) {
        // Entries whose pictures cannot be loaded have none.
        if let Some(come) = self.coming.as_ref().and_then(Task::poll) {
            self.coming = None;
            for (kind, image) in come.into_iter().flatten() {
                let texture = context.load_texture(format!("what {} does", kind.0), image, TextureOptions::LINEAR);
                self.textures.insert(kind, texture);
            }
        }
        if self.coming.is_some() {
            return;
        }
        let wanted = std::mem::take(self.wanted.get_mut());
        let kinds: Vec<(String, PictureSize)> = wanted.difference(&self.started).cloned().collect();
        if !kinds.is_empty() {
            self.started.extend(kinds.iter().cloned());
            self.coming = Some(Task::start(context, move || {
                kinds.into_iter().filter_map(|(kind, side)| drawn(kind, side)).collect()
            }));
        }
    }

    /// Picture of a kind, once it is loaded; asks for it otherwise.
    pub(super) fn find(&self, kind: &str, side: PictureSize) -> Option<TextureId> {
        let key = (kind.to_owned(), side);
        let found = self.textures.get(&key).map(TextureHandle::id);
        if found.is_none() {
            self.wanted.borrow_mut().insert(key);
        }
        found
    }
}

fn drawn(kind: String, side: PictureSize) -> Option<((String, PictureSize), ColorImage)> {
    let picture = match Path::new(&kind) {
        file if file.is_absolute() => group_picture(file, side.pixels())?,
        _ => picture_of(&kind, side.pixels())?,
    };
    let size = picture.size.map(|side| side as usize);
    Some(((kind, side), ColorImage::from_rgba_unmultiplied(size, &picture.rgba)))
}
