//! Pictures of a model's materials. Each content is decoded once, and only as many as fit into memory.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;
use sabi_cancel::Cancel;
use sabi_surface::model::{Model, ModelImage, ModelMaterial};

use super::session_pictures::{OpenPicture, SessionPictures, memory_of};

/// Pictures of a model by their numbers, or sentences with the reason why they cannot be shown.
pub(super) type ModelPictures = BTreeMap<usize, Result<Arc<OpenPicture>, String>>;

/// Content of a picture that materials use, with the numbers of the model's pictures that have it.
struct ModelPictureContent<'m> {
    hash: [u8; 32],
    name: &'m str,
    bytes: &'m [u8],
    images: Vec<usize>,
}

/// Opens the pictures that the materials use, on all threads. Pictures that would take more than `memory_bytes` together
/// are left out, later ones first.
pub(super) fn open_pictures(model: &Model, pictures: &SessionPictures, memory_bytes: u64) -> ModelPictures {
    let (contents, mut opened) = contents(model);
    let mut left = memory_bytes;
    let mut fitting = Vec::new();
    for content in contents {
        match reserve(&content, &mut left, memory_bytes) {
            Ok(()) => fitting.push(content),
            Err(why) => opened.extend(content.images.iter().map(|image| (*image, Err(why.clone())))),
        }
    }
    let cancel = Cancel::current();
    let open = |content: &ModelPictureContent<'_>| {
        let picture = cancel.during(|| pictures.open_bytes(content.name, content.bytes, content.hash));
        picture.map_err(|why| format!("{why}; the factor is used alone"))
    };
    let decoded: Vec<Result<Arc<OpenPicture>, String>> = fitting.par_iter().map(open).collect();
    for (content, picture) in fitting.iter().zip(decoded) {
        opened.extend(content.images.iter().map(|image| (*image, picture.clone())));
    }
    opened
}

/// Lists the contents of the pictures that the materials use, and what cannot be read.
fn contents(model: &Model) -> (Vec<ModelPictureContent<'_>>, ModelPictures) {
    let textures = model.materials.iter().flat_map(ModelMaterial::textures);
    let used: BTreeSet<usize> = textures
        .filter(|texture| model.mesh.set(texture.uv_set).is_some())
        .map(|texture| texture.image)
        .collect();
    let mut contents: Vec<ModelPictureContent<'_>> = Vec::new();
    let mut places: BTreeMap<[u8; 32], usize> = BTreeMap::new();
    let mut unread = ModelPictures::new();
    for image in used {
        match model.images.get(image) {
            None => {}
            Some(ModelImage { bytes: Err(why), .. }) => drop(unread.insert(image, Err(why.clone()))),
            Some(ModelImage { name, bytes: Ok(bytes) }) => {
                let hash = *blake3::hash(bytes).as_bytes();
                let place = *places.entry(hash).or_insert(contents.len());
                if place == contents.len() {
                    contents.push(ModelPictureContent {
                        hash,
                        name,
                        bytes,
                        images: Vec::new(),
                    });
                }
                contents[place].images.push(image);
            }
        }
    }
    (contents, unread)
}

/// Subtracts the memory of a picture from the remaining memory. The error is a sentence. Damaged pictures are reported when
/// they are decoded.
fn reserve(content: &ModelPictureContent<'_>, left: &mut u64, all: u64) -> Result<(), String> {
    // A picture that is used both for color and for values has copies of both kinds, but few pictures are.
    let Ok(needed) = memory_of(content.name, content.bytes, 1) else {
        return Ok(());
    };
    match left.checked_sub(needed) {
        Some(rest) => {
            *left = rest;
            Ok(())
        }
        None => Err(format!(
            "the picture {} takes {} MiB of memory, and {} of the {} MiB for the pictures of a model are left; the factor is used alone",
            content.name,
            needed.div_ceil(1 << 20),
            *left >> 20,
            all >> 20
        )),
    }
}

#[cfg(test)]
mod tests {
    use sabi_surface::model::{TextureRef, Wrap};

    use super::*;
    use crate::source::session_pictures::tests::bmp;

    /// A model with a material for each of these pictures.
    fn model(grays: &[u8]) -> Model {
        let image = |gray: &u8| ModelImage {
            name: format!("{gray}.bmp"),
            bytes: Ok(bmp(*gray).into()),
        };
        let mut model = Model {
            images: grays.iter().map(image).collect(),
            ..Model::default()
        };
        model.mesh.uv_set = Some(0);
        model.materials = (0..grays.len())
            .map(|image| ModelMaterial {
                base_color: Some(TextureRef {
                    image,
                    wrap: [Wrap::Repeat; 2],
                    transform: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
                    uv_set: 0,
                }),
                ..ModelMaterial::default()
            })
            .collect();
        model
    }

    #[test]
    fn a_picture_that_fifteen_materials_bring_is_decoded_once() {
        let mut grays = vec![7; 15];
        grays.push(8);
        let opened = open_pictures(&model(&grays), &SessionPictures::default(), u64::MAX);
        let picture = |image: usize| opened[&image].as_ref().expect("a picture");
        assert_eq!(opened.len(), 16);
        assert!((1..15).all(|image| Arc::ptr_eq(picture(0), picture(image))));
        assert!(!Arc::ptr_eq(picture(0), picture(15)));
    }

    #[test]
    fn pictures_that_do_not_fit_are_left_out_before_they_are_decoded() {
        let needed = memory_of("7.bmp", &bmp(7), 1).expect("a picture");
        let pictures = SessionPictures::default();
        let opened = open_pictures(&model(&[7, 7, 8, 9]), &pictures, 2 * needed);
        let why = |image: usize| opened[&image].as_ref().err().cloned();
        assert_eq!([0, 1, 2].map(why), [None, None, None]);
        assert_eq!(
            why(3).as_deref(),
            Some(
                "the picture 9.bmp takes 1 MiB of memory, and 0 of the 0 MiB for the pictures of a model are left; the factor is used \
                 alone"
            )
        );
        assert_eq!(pictures.kept(), 2);
    }
}
