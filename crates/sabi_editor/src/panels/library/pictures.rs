//! Small pictures of what built-in nodes and groups do, loaded on a thread of their own when they come into sight.

use std::cell::RefCell;
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_engine::catalog::picture_of;
use sabi_engine::group_picture;

use crate::task::Task;

/// Pixels along a side.
const SIDE: u32 = 72;

/// Small pictures of what built-in nodes do, by id, and groups of the effect library, by file.
#[derive(Default)]
pub(super) struct Pictures {
    coming: Option<Task<Vec<(String, ColorImage)>>>,
    textures: BTreeMap<String, TextureHandle>,
    /// Kinds whose pictures were asked for. Filled while entries are drawn, hence the cell.
    wanted: RefCell<BTreeSet<String>>,
    /// Kinds whose loading was started.
    started: BTreeSet<String>,
}

impl Pictures {
    /// Takes over the pictures that are loaded, and starts loading those that were asked for since.
    pub(super) fn poll(&mut self, context: &Context) {
        // Entries whose pictures cannot be loaded have none.
        if let Some(come) = self.coming.as_ref().and_then(Task::poll) {
            self.coming = None;
            for (kind, image) in come.into_iter().flatten() {
                let texture = context.load_texture(format!("what {kind} does"), image, TextureOptions::LINEAR);
                self.textures.insert(kind, texture);
            }
        }
        if self.coming.is_some() {
            return;
        }
        let wanted = std::mem::take(self.wanted.get_mut());
        let kinds: Vec<String> = wanted.difference(&self.started).cloned().collect();
        if !kinds.is_empty() {
            self.started.extend(kinds.iter().cloned());
            self.coming = Some(Task::start(context, move || {
                kinds.into_iter().filter_map(drawn).collect()
            }));
        }
    }

    /// Picture of a kind, once it is loaded; asks for it otherwise.
    pub(super) fn find(&self, kind: &str) -> Option<TextureId> {
        let found = self.textures.get(kind).map(TextureHandle::id);
        if found.is_none() {
            self.wanted.borrow_mut().insert(kind.to_owned());
        }
        found
    }
}

fn drawn(kind: String) -> Option<(String, ColorImage)> {
    let picture = match Path::new(&kind) {
        file if file.is_absolute() => group_picture(file, SIDE)?,
        _ => picture_of(&kind, SIDE)?,
    };
    let size = picture.size.map(|side| side as usize);
    Some((kind, ColorImage::from_rgba_unmultiplied(size, &picture.rgba)))
}
