//! Images of the scene, and where they are stored.

use glam::DAffine2;
use ufbx::{MaterialMap, Texture, TextureFile, TextureType, WrapMode};

use crate::load::material_images::{ImageLocation, MaterialImages, file_name, places};
use crate::load::warnings::Warnings;
use crate::model::{TextureRef, Wrap};

/// Returns the texture that is connected to a value of a material, if it is enabled.
pub(super) fn connected(map: &MaterialMap) -> Option<&Texture> {
    map.texture.as_deref().filter(|_| map.texture_enabled)
}

/// Converts textures of the scene to images of the model.
pub(super) struct FbxTextures<'s> {
    scene: &'s ufbx::Scene,
    /// Name of the model's file without its ending.
    stem: String,
}

impl<'s> FbxTextures<'s> {
    pub(super) fn new(scene: &'s ufbx::Scene, stem: String) -> FbxTextures<'s> {
        FbxTextures { scene, stem }
    }

    /// Returns how a texture is used. `set` returns the UV set for its name. In warnings, `of` is the material and `what` the value.
    pub(super) fn used(
        &self,
        texture: &Texture,
        set: impl FnOnce(&str) -> u32,
        [what, of]: [&str; 2],
        pictures: &mut MaterialImages,
        warnings: &mut Warnings,
    ) -> Option<TextureRef> {
        // Layered textures and procedural textures have image textures below them.
        let file = if texture.has_file {
            Some(texture)
        } else {
            texture.file_textures.into_iter().next()
        };
        let file = file.and_then(|file| Some((file, self.scene.texture_files.get(file.file_index as usize)?)));
        let Some((file, picture)) = file.filter(|(file, _)| file.has_file) else {
            warnings.add(format!(
                "The {what} of {of} is no picture and is left out; bake it to one."
            ));
            return None;
        };
        if texture.type_ == TextureType::Layered && texture.file_textures.len() > 1 {
            warnings.add(format!(
                "The {what} of {of} has several layers; only the first is taken."
            ));
        }
        let number = pictures.number(&picture.index.to_string(), || self.place(picture, file));
        let wrap = [file.wrap_u, file.wrap_v].map(|wrap| match wrap {
            WrapMode::Repeat => Wrap::Repeat,
            WrapMode::Clamp => Wrap::Clamp,
        });
        Some(TextureRef {
            image: number,
            wrap,
            transform: if file.has_uv_transform {
                transform(file)
            } else {
                TextureRef::of(0).transform
            },
            uv_set: set(&file.uv_set),
        })
    }

    /// Returns the name of an image and the places where it may be: inside the file, at the path relative to the file, in
    /// the folder of the same name into which FBX programs extract images, and by its bare file name. Absolute paths belong
    /// to another computer, so only their last part is used.
    fn place(&self, picture: &TextureFile, texture: &Texture) -> (String, ImageLocation) {
        let paths = [
            &picture.relative_filename,
            &picture.filename,
            &picture.absolute_filename,
            &texture.relative_filename,
        ];
        let paths: Vec<&str> = paths
            .into_iter()
            .map(|path| &**path)
            .filter(|path| !path.is_empty())
            .collect();
        let name = paths
            .first()
            .map_or_else(|| texture.element.name.to_string(), |path| file_name(path));
        let content = [&picture.content, &texture.content]
            .into_iter()
            .find(|content| !content.is_empty());
        if let Some(content) = content {
            return (name, ImageLocation::Inside(content.to_vec().into()));
        }
        let unpacked = [format!("{}.fbm", self.stem)];
        (name, ImageLocation::Beside(places(&paths, &unpacked)))
    }
}

/// Returns the rows of the transform of coordinates. v grows upward in the scene and downward in the model, so that V = 1 − v on both
/// sides. It is the inverse of the texture's own transform in two dimensions only, since some programs (assimp) scale the third by 0.
fn transform(texture: &Texture) -> [[f32; 3]; 2] {
    let own = &texture.texture_to_uv;
    let up = DAffine2::from_cols_array(&[own.m00, own.m10, own.m01, own.m11, own.m03, own.m13]).inverse();
    let [a, d, b, e, c, f] = up.to_cols_array();
    let rows = [[a, -b, c + b], [-d, e, 1.0 - e - f]];
    let rows = rows.map(|row| row.map(|x| x as f32));
    if rows.as_flattened().iter().all(|x| x.is_finite()) {
        rows
    } else {
        TextureRef::of(0).transform
    }
}
