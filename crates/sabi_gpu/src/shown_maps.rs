//! Maps that are shown: results, or copies of them that are changed like exported maps, where charts share a place and
//! where values jump at the border of a chart.

use sabi_nodes::link::Format;

use crate::borders::{BorderKind, Borders};
use crate::cache::ResultCache;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::formats::format_of;
use crate::made_map::MadeMap;
use crate::run_result::Run;
use crate::shares::{Mean, Shares};
use crate::surface::GpuSurface;
use crate::tile_set::{TILE_EXTENT, TileSet, copied_tile};

/// Changes that exported maps have and that shown maps take over; none to show the results as they are in each chart.
#[derive(Clone, Copy, Default)]
pub struct Exported<'a> {
    /// Texels that share a place on the maps.
    pub shares: Option<&'a Shares>,
    /// Ghosts that repeat their chart beyond a jump.
    pub borders: Option<&'a Borders>,
    /// True if ghosts are changed in the results themselves, which saves a copy. For results that nothing else reads.
    pub changes_results: bool,
}

/// Map of a run that is to be shown.
pub(crate) struct ShownMap {
    /// Its texture. It must not be changed, since others may read it.
    pub(crate) texture: wgpu::Texture,
    /// Key for the copy that a cache keeps; `None` if there is none.
    pub(crate) made: Option<MadeMap>,
    pub(crate) kind: BorderKind,
    pub(crate) mean: Mean,
    /// True if nothing else needs the texture, so that it returns to the pool once it has been copied.
    pub(crate) is_spare: bool,
}

impl Gpu {
    /// Returns the textures of maps as they are shown. A map that equals its exported map is shown without a copy. Copies
    /// of other maps are kept in a cache, and only changed tiles are copied again.
    pub(crate) fn shown_maps(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        exported: Exported<'_>,
        maps: Vec<ShownMap>,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<Vec<wgpu::Texture>, GpuError> {
        if let (Some(borders), true) = (exported.borders, exported.changes_results) {
            for map in &maps {
                self.repeat_charts(surface, borders, [&map.texture; 2], map.kind)?;
            }
            let exported = Exported {
                borders: None,
                ..exported
            };
            let maps = maps.into_iter();
            let shown = maps.map(|map| self.shown_map(surface, run, exported, map, None));
            return shown.collect();
        }
        let mut known: Vec<Option<wgpu::Texture>> = Vec::new();
        for map in &maps {
            known.push(cache.as_deref_mut().and_then(|cache| known_map(map, exported, cache)));
        }
        let unknown = || maps.iter().zip(&known).filter(|(_, known)| known.is_none());
        let jumping = match exported.borders {
            Some(borders) => {
                let asked: Vec<(&wgpu::Texture, BorderKind)> =
                    unknown().map(|(map, _)| (&map.texture, map.kind)).collect();
                self.find_jumps(surface, borders, &asked)?
            }
            None => unknown().map(|_| false).collect(),
        };
        let mut jumping = jumping.into_iter();
        let mut shown = Vec::new();
        for (map, known) in maps.into_iter().zip(known) {
            shown.push(match known {
                Some(known) => known,
                None => {
                    let borders = exported.borders.filter(|_| jumping.next() == Some(true));
                    let exported = Exported { borders, ..exported };
                    self.shown_map(surface, run, exported, map, cache.as_deref_mut())?
                }
            });
        }
        Ok(shown)
    }

    /// Returns the texture of a map as it is shown. If it has ghosts beyond a jump, they repeat their chart.
    fn shown_map(
        &self,
        surface: &GpuSurface,
        run: &mut Run,
        exported: Exported<'_>,
        map: ShownMap,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<wgpu::Texture, GpuError> {
        if let (Some(cache), Some(made)) = (cache.as_deref_mut(), &map.made) {
            cache.put_jumps(made.key, exported.borders.is_some());
        }
        if exported.shares.is_none() && exported.borders.is_none() {
            return Ok(map.texture);
        }
        let before = match (cache.as_deref_mut(), &map.made) {
            (
                Some(cache),
                Some(MadeMap {
                    before: Some((key, tiles)),
                    ..
                }),
            ) => cache.take(key).map(|texture| (texture, tiles)),
            _ => None,
        };
        let format = format_of(&map.texture)?;
        // Ghosts are set first, since shared texels also show ghosts.
        let bordered = match (exported.shares, exported.borders) {
            (Some(_), Some(borders)) => {
                let bordered = self.copy(surface, run, &map.texture)?;
                self.repeat_charts(surface, borders, [&map.texture, &bordered], map.kind)?;
                Some(bordered)
            }
            _ => None,
        };
        let source = bordered.as_ref().unwrap_or(&map.texture); // Without a copy, the map itself is the source.
        let shown = match before {
            Some((shown, tiles)) => {
                self.copy_tiles(source, &shown, tiles);
                shown
            }
            None => self.copy(surface, run, source)?,
        };
        match (exported.shares, exported.borders) {
            (Some(shares), _) => self.share(surface, shares, [source, &shown], map.mean)?,
            (None, Some(borders)) => self.repeat_charts(surface, borders, [source, &shown], map.kind)?,
            (None, None) => {}
        }
        let spare = [bordered, map.is_spare.then_some(map.texture)];
        for texture in spare.into_iter().flatten() {
            run.pool.release(format, texture);
        }
        if let (Some(cache), Some(made)) = (cache, map.made) {
            cache.put(made.key, shown.clone(), format.texel_bytes() * surface.texels());
        }
        Ok(shown)
    }

    /// Copy of a texture on the atlas.
    fn copy(&self, surface: &GpuSurface, run: &mut Run, texture: &wgpu::Texture) -> Result<wgpu::Texture, GpuError> {
        let format: Format = format_of(texture)?;
        let copy = run.pool.take(self, format, surface.extent)?;
        run.report.pool = run.pool.report();
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_texture(texture.as_image_copy(), copy.as_image_copy(), texture.size());
        self.queue.submit([encoder.finish()]);
        Ok(copy)
    }

    fn copy_tiles(&self, from: &wgpu::Texture, to: &wgpu::Texture, tiles: &TileSet) {
        let mut encoder = self
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for place in tiles.places() {
            encoder.copy_texture_to_texture(copied_tile(from, place), copied_tile(to, place), TILE_EXTENT);
        }
        self.queue.submit([encoder.finish()]);
    }
}

/// Returns the texture of a map if it is in a cache, or if the map is known to equal its exported map.
fn known_map(map: &ShownMap, exported: Exported<'_>, cache: &mut ResultCache) -> Option<wgpu::Texture> {
    let key = map.made.as_ref()?.key;
    let is_plain = exported.shares.is_none() && (exported.borders.is_none() || cache.jumps(&key) == Some(false));
    match is_plain {
        true => Some(map.texture.clone()),
        false => cache.get(&key),
    }
}
