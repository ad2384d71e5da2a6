//! Planes of a result of a model, drawn material by material.

use std::collections::BTreeMap;

use sabi_gpu::{
    DeviceTable, DirectionConstants, GpuError, NO_CHANNEL, PictureStorage, SourceCanvas, SourceDraw, SourceShader,
    TEXTURES, TextureConstants, TexturesConstants, TileSet,
};

use super::corners::Coordinates;
use super::model_textures::{ModelTexture, Product, channel_number, textures_of};
use super::picture_table::PictureTable;
use super::texels::SourceSurface;

/// Tables of the texture coordinates of UV sets by the number of the set.
pub(super) type CoordinateTables = BTreeMap<u32, DeviceTable>;

/// Texels of one material of a plane.
pub(super) struct MaterialCanvas<'a> {
    pub(super) canvas: &'a SourceCanvas<'a>,
    pub(super) surface: &'a SourceSurface<'a>,
    /// Number of the material.
    pub(super) material: u32,
    /// Tiles with triangles of the material; `None` for all.
    pub(super) tiles: Option<&'a TileSet>,
    pub(super) coordinates: &'a mut CoordinateTables,
    /// Bound where there is no table.
    pub(super) unused: &'a DeviceTable,
    /// Warnings about textures that cannot be shown.
    pub(super) warnings: &'a mut Vec<String>,
}

/// A texture on the device.
struct BoundTexture {
    picture: PictureTable,
    coordinates: Option<(DeviceTable, u32)>,
}

impl MaterialCanvas<'_> {
    /// Fills the texels with products of channels.
    ///
    /// # Errors
    /// The run is canceled, or the device refuses.
    pub(super) fn products(&mut self, products: [Product<'_>; 4]) -> Result<(), GpuError> {
        let textures = textures_of(&products);
        let bound: Vec<BoundTexture> = textures
            .iter()
            .map(|texture| self.bound(texture))
            .collect::<Result<_, _>>()?;
        let number = |at: usize| {
            products.map(|product| channel_number(&textures, product.channels[at]).unwrap_or(NO_CHANNEL)) // 1 in the shader.
        };
        // A material has one cutoff.
        let cutoff = products.iter().find_map(|product| product.cutoff);
        let cut = products.iter().zip(0..).filter(|(product, _)| product.cutoff.is_some());
        let mut constants = TexturesConstants {
            material: self.material,
            cutoff: cutoff.unwrap_or_default(),
            is_cut: cut.map(|(_, component)| 1 << component).sum(),
            pad: 0,
            first: number(0),
            second: number(1),
            factor: products.map(|product| product.factor),
            addend: products.map(|product| product.addend),
            used: [TextureConstants::default(); TEXTURES],
        };
        let mut storages = [PictureStorage::None; TEXTURES];
        let mut tables = [self.unused; 2 * TEXTURES];
        for (at, (texture, bound)) in textures.iter().zip(&bound).enumerate() {
            constants.used[at] = bound.constants(texture);
            storages[at] = bound.picture.storage;
            tables[at] = &bound.picture.table;
            tables[TEXTURES + at] = bound.coordinates.as_ref().map_or(self.unused, |(table, _)| table);
        }
        self.canvas.draw(&SourceDraw {
            shader: SourceShader::Textures(storages),
            constants,
            tables: &tables,
            tiles: self.tiles,
        })
    }

    /// Fills the texels with the directions of a texture: the slope of a normal map, or fine scratches under a rotation, radians.
    ///
    /// # Errors
    /// The run is canceled, or the device refuses.
    pub(super) fn directions(
        &mut self,
        texture: Option<&ModelTexture<'_>>,
        factor: f32,
        rotation: Option<f32>,
    ) -> Result<(), GpuError> {
        let bound = texture.map(|texture| self.bound(texture)).transpose()?;
        let (sin, cos) = rotation.unwrap_or(0.0).sin_cos(); // Slopes are not rotated.
        let used = texture.zip(bound.as_ref());
        let constants = DirectionConstants {
            material: self.material,
            factor,
            turn: [cos, sin],
            // Without a texture the kernel does not read it.
            used: used.map_or(TextureConstants::default(), |(texture, bound)| bound.constants(texture)),
        };
        let coordinates = bound.as_ref().and_then(|bound| bound.coordinates.as_ref());
        self.canvas.draw(&SourceDraw {
            shader: SourceShader::Directions {
                storage: bound
                    .as_ref()
                    .map_or(PictureStorage::None, |bound| bound.picture.storage),
                shows_slope: rotation.is_none(),
            },
            constants,
            tables: &[
                bound.as_ref().map_or(self.unused, |bound| &bound.picture.table),
                coordinates.map_or(self.unused, |(table, _)| table),
            ],
            tiles: self.tiles,
        })
    }

    /// Uploads a texture, and the coordinates of its UV set if they have not been uploaded yet.
    fn bound(&mut self, texture: &ModelTexture<'_>) -> Result<BoundTexture, GpuError> {
        let picture = PictureTable::upload(self.canvas, &texture.levels)?;
        let why = picture.why_smaller(&format!("the picture {}", texture.name));
        self.warnings.extend(why.filter(|why| !self.warnings.contains(why)));
        if texture.is_laid_out_by_the_atlas() {
            return Ok(BoundTexture {
                picture,
                coordinates: None,
            });
        }
        let of_set = Coordinates {
            other: texture.other,
            covers: &|triangle| texture.covers(triangle),
        };
        let table = match self.coordinates.get(&texture.uv_set) {
            Some(known) => known.clone(),
            None => {
                let table = of_set.upload(self.canvas, self.surface)?;
                self.coordinates.insert(texture.uv_set, table.clone());
                table
            }
        };
        Ok(BoundTexture {
            picture,
            coordinates: Some((table, of_set.row_count())),
        })
    }
}

impl BoundTexture {
    /// Constants for reading the texture.
    fn constants(&self, texture: &ModelTexture<'_>) -> TextureConstants {
        let [u, v] = texture.transform;
        TextureConstants {
            u,
            v,
            coordinate_rows: self.coordinates.as_ref().map_or(0, |(_, rows)| *rows), // 0 is for those of the atlas.
            picture: self.picture.constants(texture.wrap),
            ..TextureConstants::default()
        }
    }
}
