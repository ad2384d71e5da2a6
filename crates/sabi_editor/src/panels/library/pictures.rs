//! What nodes that come with the program do, in small pictures, made ready beside the window.

use std::collections::BTreeMap;

use egui::{ColorImage, Context, TextureHandle, TextureId, TextureOptions};
use sabi_engine::catalog::{Catalog, picture_of};

use crate::errand::Errand;

/// Pixels along a side.
const SIDE: u32 = 72;

/// Small pictures of nodes.
#[derive(Default)]
pub(super) struct Pictures {
    coming: Option<Errand<Vec<(String, ColorImage)>>>,
    textures: BTreeMap<String, TextureHandle>,
}

impl Pictures {
    /// Begins to make them where that was not begun, and takes them once they are there.
    pub(super) fn poll(&mut self, context: &Context, catalog: &Catalog) {
        if self.coming.is_none() {
            let kinds: Vec<String> = catalog.entries().map(|entry| entry.id.clone()).collect();
            self.coming = Some(Errand::start(context, move || {
                kinds.into_iter().filter_map(drawn).collect()
            }));
        }
        // A mistake in the making leaves the entries without pictures.
        let Some(Ok(come)) = self.coming.as_ref().and_then(Errand::poll) else {
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
