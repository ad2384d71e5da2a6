//! Pictures of brushes. They are in a folder beside the strokes that use them, and named by their content.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sabi_files::{TrustedPaths, read_plain};
use sabi_image::{PngData, PngOptions, encode_png};
use sabi_paint::{PictureName, StampPicture, StampPictures, StrokeList};

use super::{Strokes, base_of, paint_folder};

/// Maximum size of a picture file that is read.
const FILE_LIMIT_BYTES: u64 = 256 << 20;

/// A picture in memory.
#[derive(Clone)]
pub(super) struct KeptPicture {
    /// Its file.
    bytes: Arc<Vec<u8>>,
    stamp: Arc<StampPicture>,
}

/// The pictures of some strokes.
#[derive(Default)]
pub(crate) struct FoundPictures {
    pub(crate) pictures: StampPictures,
    /// Pictures that are missing beside the graph, or damaged.
    pub(crate) missing: Vec<PictureName>,
}

/// Folder of the pictures of brushes in a folder of strokes.
pub(crate) fn picture_folder(paint: &Path) -> PathBuf {
    paint.join("pictures")
}

/// Names of the pictures that strokes stamp.
fn names_of(list: &StrokeList) -> BTreeSet<PictureName> {
    let pictures = list.strokes.iter().flat_map(|stroke| stroke.pictures());
    pictures.cloned().collect()
}

impl Strokes {
    /// Takes a picture for brushes; strokes that stamp it are stored with it.
    ///
    /// # Errors
    /// A sentence about a file that cannot be read or is no picture.
    pub fn take_picture(&self, file: &Path) -> Result<PictureName, String> {
        let shown = file.display();
        let bytes = read_plain(file, FILE_LIMIT_BYTES).map_err(|_| {
            let most = FILE_LIMIT_BYTES >> 20;
            format!("{shown} cannot be read as the picture of a brush, or is larger than {most} MiB")
        })?;
        let ending = file.extension().and_then(|ending| ending.to_str()).unwrap_or_default(); // None, which is no ending.
        self.keep_picture(bytes, ending)
            .map_err(|why| format!("{shown}: {why}"))
    }

    /// Takes the bytes of a picture file for brushes, as [`Strokes::take_picture`] does.
    ///
    /// # Errors
    /// A sentence about bytes that are no picture.
    pub fn keep_picture(&self, bytes: Vec<u8>, ending: &str) -> Result<PictureName, String> {
        let name = PictureName::of(&bytes, ending).ok_or("a picture of a brush needs the usual ending of its file")?;
        let kept = KeptPicture::read(&name, bytes)?;
        self.lock().pictures.insert(name.clone(), kept);
        Ok(name)
    }

    /// Takes a picture of shapes for brushes: how opaque each pixel is, row by row from the top, as many as `size` says.
    ///
    /// # Errors
    /// A sentence about a picture that is too large.
    pub fn keep_shapes(&self, size: [usize; 2], alpha: &[u8]) -> Result<PictureName, String> {
        let pixels: Vec<u8> = alpha.iter().flat_map(|alpha| [255, *alpha]).collect();
        let options = PngOptions {
            channels: 2,
            bits: 8,
            srgb_chunk: true,
        };
        let [width, height] = size.map(|side| side as u32);
        let png = encode_png(width, height, PngData::U8(&pixels), options).map_err(|error| error.to_string())?;
        self.keep_picture(png, "png")
    }

    /// Returns a picture that was added or read; `None` if it is not in memory.
    pub fn picture(&self, name: &PictureName) -> Option<Arc<StampPicture>> {
        self.lock().pictures.get(name).map(|kept| kept.stamp.clone())
    }

    /// Returns the file of a picture that was added or read; `None` if it is not in memory.
    pub fn picture_file(&self, name: &PictureName) -> Option<Arc<Vec<u8>>> {
        self.lock().pictures.get(name).map(|kept| kept.bytes.clone())
    }

    /// The pictures of strokes beside a graph.
    pub(crate) fn pictures_of(&self, graph: &Path, list: &StrokeList) -> FoundPictures {
        let folder = paint_folder(graph);
        let mut found = FoundPictures::default();
        for name in names_of(list) {
            let known = self.lock().pictures.get(&name).cloned();
            // Read while nothing is locked, since the window needs strokes in the meantime.
            match known.or_else(|| self.open_picture(&folder, &name)) {
                Some(kept) => {
                    found.pictures.insert(name.clone(), kept.stamp.clone());
                    self.lock().pictures.insert(name, kept);
                }
                None => found.missing.push(name),
            }
        }
        found
    }

    /// Reads a picture of a folder of strokes. A file that could not be used is read again once it has changed.
    fn open_picture(&self, paint: &Path, name: &PictureName) -> Option<KeptPicture> {
        let file = picture_folder(paint).join(name.as_str());
        let stamp = super::stamp(&file)?;
        let trusted = {
            let state = self.lock();
            if state.bad_pictures.get(&file) == Some(&stamp) {
                return None;
            }
            state.trusted.clone()
        };
        let opened = KeptPicture::open(&trusted, paint, name);
        if opened.is_none() {
            self.lock().bad_pictures.insert(file, stamp);
        }
        opened
    }

    /// Reads all pictures beside a graph, so that its strokes can be stored elsewhere.
    pub(super) fn read_pictures(&self, graph: &Path) {
        let paint = paint_folder(graph);
        let Ok(entries) = std::fs::read_dir(picture_folder(&paint)) else {
            return;
        };
        for entry in entries.filter_map(Result::ok) {
            let name = entry
                .file_name()
                .into_string()
                .ok()
                .and_then(|name| PictureName::try_from(name).ok());
            let mut state = self.lock();
            if let Some(name) = name.filter(|name| !state.pictures.contains_key(name))
                && let Some(kept) = KeptPicture::open(&state.trusted, &paint, &name)
            {
                state.pictures.insert(name, kept);
            }
        }
    }
}

impl KeptPicture {
    fn read(name: &PictureName, bytes: Vec<u8>) -> Result<KeptPicture, String> {
        let stamp = StampPicture::read(name.as_str(), &bytes).map_err(|error| error.to_string())?;
        Ok(KeptPicture {
            bytes: Arc::new(bytes),
            stamp: Arc::new(stamp),
        })
    }

    /// Reads a picture of a folder of strokes; `None` if it is missing, does not match its name, or may not be opened.
    fn open(trusted: &TrustedPaths, paint: &Path, name: &PictureName) -> Option<KeptPicture> {
        let file = picture_folder(paint).join(name.as_str());
        let bytes = trusted.read_at(&base_of(paint), &file, FILE_LIMIT_BYTES).ok()?;
        let bytes = Some(bytes).filter(|bytes| name.is_of(bytes))?;
        KeptPicture::read(name, bytes).ok()
    }
}

impl super::StrokesState {
    /// Stores the pictures of strokes in a folder of strokes, unless they are there.
    pub(super) fn store_pictures(&self, paint: &Path, list: &StrokeList) -> Result<(), String> {
        let folder = picture_folder(paint);
        for name in names_of(list) {
            let file = folder.join(name.as_str());
            // A missing picture is reported when it is painted.
            let Some(kept) = self.pictures.get(&name) else { continue };
            let length = std::fs::metadata(&file).map(|file| file.len());
            if length.is_ok_and(|length| length == kept.bytes.len() as u64) {
                continue;
            }
            let refused = |why: String| format!("the picture of a brush is not stored: {why}");
            self.disk
                .write_whole(&file, &kept.bytes)
                .map_err(|error| refused(error.to_string()))?;
        }
        Ok(())
    }
}
