//! The encoded bytes of images: in the file, in a buffer view, or beside the model.

use std::collections::BTreeMap;
use std::sync::Arc;

use sabi_files::{Uri, find_beside};

use super::Resolve;
use super::source::GltfSource;
use crate::model::ModelImage;

/// Images that were read. Each is in memory only once, however many textures use it.
#[derive(Default)]
pub(super) struct GltfImageCache {
    beside: BTreeMap<String, Result<Arc<[u8]>, String>>,
    /// Images in buffer views, by buffer, offset and length.
    in_views: BTreeMap<[u64; 3], Arc<[u8]>>,
    /// Total size of the images in buffer views, in bytes.
    bytes_in_views: u64,
}

impl GltfImageCache {
    /// Reads the image `index` of the file. `unread` is the unsupported extension that its format needs, if any.
    pub(super) fn read(
        &mut self,
        source: &GltfSource,
        model: &str,
        index: usize,
        unread: Option<&'static str>,
        resolve: &mut Resolve,
    ) -> ModelImage {
        let image = &source.document.images[index];
        let uri = image.uri.as_deref().map(|raw| (raw, Uri::parse(raw)));
        let name = match &uri {
            Some((_, Uri::Beside(path))) => path
                .rsplit_once(['/', '\\'])
                .map_or(&**path, |(_, name)| name)
                .to_string(),
            _ => format!("image {index} of {model}"),
        };
        let bytes: Result<Arc<[u8]>, String> = match (unread, uri, image.buffer_view) {
            (Some(extension), ..) => Err(format!("it is stored with {extension}, which is not read here")),
            (_, Some((_, Uri::Data(bytes))), _) => Ok(bytes.into()),
            (_, Some((raw, Uri::Beside(path))), _) => {
                let known = self.beside.entry(raw.to_string());
                known.or_insert_with(|| find_beside(raw, &path, resolve)).clone()
            }
            (_, Some((_, Uri::Damaged(reason) | Uri::Unusable(reason))), _) => Err(reason),
            (_, None, Some(view)) => self.in_view(source, view.value()),
            (_, None, None) => Err("the file does not say where it is".to_string()),
        };
        let bytes = bytes.map_err(|reason| format!("The picture {name} cannot be read: {reason}."));
        ModelImage { name, bytes }
    }

    /// Reads an image in a buffer view. If different images together have more bytes than the buffers, they overlap, which is refused.
    fn in_view(&mut self, source: &GltfSource, index: usize) -> Result<Arc<[u8]>, String> {
        let bytes = source.buffers.view(source.document, index);
        let bytes = bytes.map_err(|fault| fault.to_string())?;
        let view = &source.document.views[index];
        let place = [
            view.buffer.value() as u64,
            // 0 is glTF's default.
            view.byte_offset.unwrap_or_default().0,
            view.byte_length.0,
        ];
        if let Some(known) = self.in_views.get(&place) {
            return Ok(known.clone());
        }
        self.bytes_in_views += bytes.len() as u64;
        if self.bytes_in_views > source.buffers.total_bytes() {
            return Err("the pictures of the file overlap".into());
        }
        let bytes: Arc<[u8]> = bytes.into();
        self.in_views.insert(place, bytes.clone());
        Ok(bytes)
    }
}
