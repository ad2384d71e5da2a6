//! Small pictures of what built-in nodes do, loaded on a thread of their own.

use std::collections::BTreeMap;

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_engine::catalog::{Catalog, picture_of};

use crate::task::Task;

/// Pixels along a side.
const SIDE: u32 = 72;

/// Small pictures of what built-in nodes do.
#[derive(Default)]
pub(super) struct Pictures {
    coming: Option<Task<Vec<(String, ColorImage)>>>,
    textures: BTreeMap<String, TextureHandle>,
}

impl Pictures {
    /// Starts loading the pictures, and takes them over once they are loaded.
    pub(super) fn poll(&mut self, context: &Context, catalog: &Catalog) {
        if self.coming.is_none() {
            let kinds: Vec<String> = catalog.entries().map(|entry| entry.id.clone()).collect();
            self.coming = Some(Task::start(context, move || {
                kinds.into_iter().filter_map(drawn).collect()
            }));
        }
        // Where loading fails, entries have no pictures.
        let Some(Ok(come)) = self.coming.as_ref().and_then(Task::poll) else {
            return;
        };
        for (kind, image) in come {
            let texture = context.load_texture(format!("what {kind} does"), image, TextureOptions::LINEAR);
            self.textures.insert(kind, texture);
        }
    }

    pub(super) fn find(&self, kind: &str) -> Option<TextureId> {
        self.textures.get(kind).map(TextureHandle::id)
    }
}

fn drawn(kind: String) -> Option<(String, ColorImage)> {
    let picture = picture_of(&kind, SIDE)?;
    let size = picture.size.map(|side| side as usize);
    Some((kind, ColorImage::from_rgba_unmultiplied(size, &picture.rgba)))
}
