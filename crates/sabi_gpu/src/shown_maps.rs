//! Maps that are shown: results, or copies of them with the values that exported maps have where charts share a place and where data
//! jumps at the border of a chart.

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

/// What shown maps take over from exported ones; nothing for the results of each chart alone.
#[derive(Clone, Copy, Default)]
pub struct Exported<'a> {
    /// Texels that share a place on the maps.
    pub shares: Option<&'a Shares>,
    /// Ghosts that repeat their chart beyond a jump.
    pub borders: Option<&'a Borders>,
    /// True if ghosts are changed in the results themselves, since nothing but what is shown reads these results any more: no map has a
    /// copy for its borders then.
    pub changes_results: bool,
}

/// Map of a run that is to be shown.
pub(crate) struct ShownMap {
    /// Its texels; others may read them, so they are not changed.
    pub(crate) texture: wgpu::Texture,
    /// The copy that a cache keeps; none where it has no key.
    pub(crate) made: Option<MadeMap>,
    pub(crate) kind: BorderKind,
    pub(crate) mean: Mean,
    /// True if nothing else needs the texture, so that it returns to the pool once there is a copy.
    pub(crate) is_spare: bool,
}

impl Gpu {
    /// Textures of maps as they are shown. One that differs nowhere from an exported map is shown itself; of others there are copies,
    /// which a cache keeps and of which only what has changed is copied again.
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

    /// Texture of a map as it is shown; with borders where it has ghosts beyond a jump.
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
        // Shared texels show ghosts as well, so those are settled first.
        let bordered = match (exported.shares, exported.borders) {
            (Some(_), Some(borders)) => {
                let bordered = self.copy(surface, run, &map.texture)?;
                self.repeat_charts(surface, borders, [&map.texture, &bordered], map.kind)?;
                Some(bordered)
            }
            _ => None,
        };
        let source = bordered.as_ref().unwrap_or(&map.texture); // Without a copy it is the map itself.
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

/// Texture of a map that a cache has, or that is known to differ nowhere from an exported map.
fn known_map(map: &ShownMap, exported: Exported<'_>, cache: &mut ResultCache) -> Option<wgpu::Texture> {
    let key = map.made.as_ref()?.key;
    let is_plain = exported.shares.is_none() && (exported.borders.is_none() || cache.jumps(&key) == Some(false));
    match is_plain {
        true => Some(map.texture.clone()),
        false => cache.get(&key),
    }
}
