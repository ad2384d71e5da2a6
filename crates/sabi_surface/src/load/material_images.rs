//! Images of materials, in the form common to the formats other than glTF.

use sabi_cancel::look;
use std::collections::BTreeMap;
use std::sync::Arc;

use super::gltf::Resolve;
use super::warnings::Warnings;
use crate::model::{Model, ModelImage, ModelMaterial};

/// Where an image is stored.
pub(super) enum ImageLocation {
    /// In the model's own file; these are its encoded bytes.
    Inside(Arc<[u8]>),
    /// Beside the model; these are possible paths, most likely first.
    Beside(Vec<String>),
}

/// Images by the key with which materials refer to them, each once. They are read when it is known which materials are used.
#[derive(Default)]
pub(super) struct MaterialImages {
    places: Vec<(String, ImageLocation)>,
    numbers: BTreeMap<String, usize>,
}

impl MaterialImages {
    /// Returns the number of the image `key`. A new image is at `place`, with a name for messages.
    pub(super) fn number(&mut self, key: &str, place: impl FnOnce() -> (String, ImageLocation)) -> usize {
        if let Some(number) = self.numbers.get(key) {
            return *number;
        }
        let number = self.places.len();
        self.places.push(place());
        self.numbers.insert(key.to_string(), number);
        number
    }

    /// Returns the number of a picture in a file that the model names.
    pub(super) fn beside(&mut self, path: &str) -> usize {
        self.number(path, || {
            (file_name(path), ImageLocation::Beside(vec![path.to_string()]))
        })
    }

    /// Reads the images that the model's materials use. Until then, textures refer to the numbers given here.
    pub(super) fn read(self, resolve: &mut Resolve, model: &mut Model, warnings: &mut Warnings) {
        let mut places: Vec<Option<(String, ImageLocation)>> = self.places.into_iter().map(Some).collect();
        let mut new_from_old = BTreeMap::new();
        for texture in model.materials.iter_mut().flat_map(ModelMaterial::textures_mut) {
            let next = model.images.len();
            let new = *new_from_old.entry(texture.image).or_insert(next);
            if let Some((name, place)) = places.get_mut(texture.image).and_then(Option::take) {
                let bytes = bytes(place, resolve);
                let bytes = bytes.map_err(|reason| format!("The picture {name} cannot be read: {reason}."));
                if let Err(sentence) = &bytes {
                    warnings.add(sentence.clone());
                }
                model.images.push(ModelImage { name, bytes });
            }
            texture.image = new;
        }
    }
}

/// Returns the file name in a path, whatever system the path is from.
pub(super) fn file_name(path: &str) -> String {
    path.rsplit_once(['/', '\\']).map_or(path, |(_, name)| name).to_string()
}

/// Returns possible places of an image to which a file refers by `paths`, most likely first: relative paths as written, then the bare
/// names in `folders` and beside the model. Absolute paths belong to another computer, so only their last part is used.
pub(super) fn places(paths: &[&str], folders: &[String]) -> Vec<String> {
    let mut places: Vec<String> = Vec::new();
    let relative = paths
        .iter()
        .filter(|path| is_relative(path))
        .map(|path| path.to_string());
    let names = paths
        .iter()
        .map(|path| file_name(path))
        .filter(|name| name != "." && name != "..");
    let below = names.flat_map(|name| {
        let inside = folders.iter().map(|folder| format!("{folder}/{name}"));
        inside.chain([name.clone()]).collect::<Vec<_>>()
    });
    for place in relative.chain(below) {
        if !place.is_empty() && !place.ends_with('/') && !places.contains(&place) {
            places.push(place);
        }
    }
    places
}

/// Returns true if a path is relative on every system.
fn is_relative(path: &str) -> bool {
    let has_drive = path.as_bytes().get(1) == Some(&b':');
    !path.starts_with(['/', '\\']) && !has_drive && !path.contains("://")
}

/// Word in a path that stands for the number of a UV tile.
const TILES: &str = "<UDIM>";

fn bytes(place: ImageLocation, resolve: &mut Resolve) -> Result<Arc<[u8]>, String> {
    let paths = match place {
        ImageLocation::Inside(bytes) => return Ok(bytes),
        ImageLocation::Beside(paths) => paths,
    };
    let mut first_reason = None;
    // Programs write the word as it is.
    if paths.iter().any(|path| path.to_ascii_uppercase().contains(TILES)) {
        first_reason = Some("it stands for a picture of each UV tile (UDIM), and one for all is read".to_owned());
    }
    for path in paths {
        look();
        match resolve(&path) {
            Ok(bytes) => return Ok(bytes),
            Err(reason) => {
                first_reason.get_or_insert(reason);
            }
        }
    }
    Err(first_reason.unwrap_or_else(|| "the file does not say where it is".to_string()))
}
