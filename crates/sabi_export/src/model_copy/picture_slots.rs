//! Adds new maps to the textures and images of a glTF file. Indices in its lists never change, since extensions may depend
//! on them: a new entry replaces an unused one, or is added at the end.

use std::collections::BTreeSet;

use sabi_files::data_uri;
use serde_json::{Value as Json, json};

use super::CopiedFile;
use super::compact::UsedEntries;
use super::container::Container;
use super::edit::{push, remove};
use super::map_file::MapFile;
use super::references;

const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;

/// The textures, pictures and buffer views of a file, while materials change theirs.
pub(super) struct PictureSlots {
    /// In use before.
    textures: BTreeSet<usize>,
    images: BTreeSet<usize>,
    /// No longer used, and not reused yet.
    free_textures: BTreeSet<usize>,
    free_images: BTreeSet<usize>,
    free_views: BTreeSet<usize>,
    /// Earlier buffer views whose bytes are no longer used.
    dead: Vec<Json>,
    /// Places of new pictures.
    new: BTreeSet<usize>,
    /// New pictures that go beside the file.
    files: Vec<CopiedFile>,
    /// True if none go beside the file.
    embeds: bool,
}

/// Placement of the pictures.
pub(super) struct PlacedPictures {
    /// Earlier buffer views whose bytes are no longer used.
    pub(super) dead: Vec<Json>,
    /// Places of new pictures.
    pub(super) new: BTreeSet<usize>,
    /// Pictures that go beside the file.
    pub(super) files: Vec<CopiedFile>,
}

fn count(document: &Json, list: &str) -> usize {
    document[list].as_array().map_or(0, Vec::len)
}

impl PictureSlots {
    /// Records what a file uses before anything is removed.
    pub(super) fn new(document: &Json, embeds: bool) -> PictureSlots {
        let all = (0..count(document, "textures")).collect();
        PictureSlots {
            textures: references::textures(document),
            images: references::images(document, &all),
            free_textures: BTreeSet::new(),
            free_images: BTreeSet::new(),
            free_views: BTreeSet::new(),
            dead: Vec::new(),
            new: BTreeSet::new(),
            files: Vec::new(),
            embeds,
        }
    }

    /// Finds the entries that are no longer used.
    pub(super) fn find_free(&mut self, document: &Json) {
        let textures = references::textures(document);
        let is_there = |list: &'static str| move |index: &usize| *index < count(document, list);
        self.free_textures = self.textures.difference(&textures).copied().collect();
        self.free_textures.retain(is_there("textures"));
        let kept = (0..count(document, "textures")).filter(|index| !self.free_textures.contains(index));
        let images = references::images(document, &kept.collect());
        self.free_images = self.images.difference(&images).copied().collect();
        self.free_images.retain(is_there("images"));
        let views = references::views(document, &self.free_images);
        let held = |index: &usize| usize::try_from(document["images"][*index]["bufferView"].as_u64()?).ok();
        self.free_views = self.free_images.iter().filter_map(held).collect();
        self.free_views.retain(is_there("bufferViews"));
        self.free_views.retain(|view| !views.contains(view));
        self.dead = self
            .free_views
            .iter()
            .map(|view| document["bufferViews"][*view].clone())
            .collect();
    }

    /// Adds a map; gives the number of its texture.
    pub(super) fn add(&mut self, document: &mut Json, container: &mut Container, map: MapFile, wrap: u32) -> usize {
        let sampler = json!({
            "magFilter": LINEAR, "minFilter": LINEAR_MIPMAP_LINEAR, "wrapS": wrap, "wrapT": wrap
        });
        let same = document["samplers"]
            .as_array()
            .and_then(|all| all.iter().position(|other| *other == sampler));
        let sampler = same.unwrap_or_else(|| push(document, "samplers", sampler));
        let name = map.name.trim_end_matches(".png");
        let image = match container.put(&map.bytes) {
            Some(view) => {
                let view = put(document, "bufferViews", &mut self.free_views, view);
                json!({ "name": name, "mimeType": "image/png", "bufferView": view })
            }
            None if self.embeds => {
                json!({ "name": name, "mimeType": "image/png", "uri": data_uri("image/png", &map.bytes) })
            }
            None => {
                if !map.is_written {
                    self.files.push(CopiedFile {
                        name: map.name.clone(),
                        bytes: map.bytes.to_vec(),
                    });
                }
                json!({ "name": name, "mimeType": "image/png", "uri": uri_of(&map.name) })
            }
        };
        let source = put(document, "images", &mut self.free_images, image);
        self.new.insert(source);
        let texture = json!({ "name": name, "sampler": sampler, "source": source });
        put(document, "textures", &mut self.free_textures, texture)
    }

    /// Removes entries that are no longer used: all of them if all references of the file are known, otherwise only those
    /// at the ends of the lists, so that no index changes.
    pub(super) fn finish(
        self,
        document: &mut Json,
        uses: Option<&UsedEntries>,
        container: &Container,
    ) -> PlacedPictures {
        match uses {
            Some(uses) => {
                let removed = uses.compact(document, container.binary_chunk().is_some());
                // Views that were replaced by new images are unused as well.
                let dead = self.dead.into_iter().chain(removed.views.iter().cloned()).collect();
                PlacedPictures {
                    new: self.new.iter().map(|image| removed.image(*image)).collect(),
                    dead,
                    files: self.files,
                }
            }
            None => self.cut_ends(document),
        }
    }

    fn cut_ends(mut self, document: &mut Json) -> PlacedPictures {
        cut(document, "textures", &self.free_textures);
        let left = (0..count(document, "textures")).collect();
        let in_use = references::images(document, &left);
        self.free_images.retain(|image| !in_use.contains(image));
        cut(document, "images", &self.free_images);
        // A picture between others keeps its bytes.
        let left = references::views(document, &BTreeSet::new());
        let (stays, free): (BTreeSet<usize>, BTreeSet<usize>) =
            self.free_views.iter().partition(|view| left.contains(view));
        for view in stays {
            let entry = &document["bufferViews"][view];
            self.dead.retain(|dead| dead != entry);
        }
        cut(document, "bufferViews", &free);
        // The bytes of an unused view that stays in the list must be kept: its range would be invalid after a cut.
        for view in free {
            let entry = &document["bufferViews"][view];
            self.dead.retain(|dead| entry.is_null() || dead != entry);
        }
        PlacedPictures {
            dead: self.dead,
            new: self.new,
            files: self.files,
        }
    }
}

/// Puts an entry into the first free place of a list, or to its end.
fn put(document: &mut Json, list: &str, free: &mut BTreeSet<usize>, value: Json) -> usize {
    match free.pop_first() {
        Some(place) => {
            document[list][place] = value;
            place
        }
        None => push(document, list, value),
    }
}

/// Removes unused entries from the end of a list; glTF forbids empty lists.
fn cut(document: &mut Json, list: &str, free: &BTreeSet<usize>) {
    let Some(entries) = document.get_mut(list).and_then(Json::as_array_mut) else {
        return;
    };
    while !entries.is_empty() && free.contains(&(entries.len() - 1)) {
        entries.pop();
    }
    if entries.is_empty() {
        remove(document, list);
    }
}

/// Media type of a picture of a format that glTF or its extensions have.
pub(super) fn media_type(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xff, 0xd8, 0xff, ..] => Some("image/jpeg"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some("image/webp"),
        [0xab, b'K', b'T', b'X', b' ', b'2', ..] => Some("image/ktx2"),
        _ => None,
    }
}

/// Percent-encodes a file name as a `uri`, all but unreserved characters (RFC 3986).
pub(super) fn uri_of(name: &str) -> String {
    name.bytes()
        .map(|byte| match byte {
            b'A'..=b'Z' | b'a'..=b'z' | b'0'..=b'9' | b'-' | b'.' | b'_' | b'~' => char::from(byte).to_string(),
            _ => format!("%{byte:02X}"),
        })
        .collect()
}
