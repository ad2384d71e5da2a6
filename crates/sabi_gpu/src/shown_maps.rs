//! Maps that are shown: results, or copies of them that are changed like exported maps, where charts share a place and
//! where values jump at the border of a chart.

use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::{Format, Plane};
use sabi_plan::SlotRef;

use crate::anisotropy::anisotropy_texture;
use crate::borders::{BorderKind, Borders};
use crate::cache::ResultCache;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::formats::format_of;
use crate::made_map::MadeMap;
use crate::maps::{DeviceMaps, MaterialSlots};
use crate::normals::Normals;
use crate::run_options::RunOptions;
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
struct ShownMap {
    /// Its texture. It must not be changed, since others may read it.
    texture: wgpu::Texture,
    /// Key for the copy that a cache keeps; `None` if there is none.
    made: Option<MadeMap>,
    kind: BorderKind,
    mean: Mean,
    /// True if nothing else needs the texture, so that it returns to the pool once it has been copied.
    is_spare: bool,
}

/// Maps of a surface as they are shown: with the changes that exported maps have.
#[derive(Clone, Copy)]
pub struct ShownMaps<'a> {
    /// Device of the runs whose results are shown.
    pub gpu: &'a Gpu,
    /// Surface of the runs.
    pub surface: &'a GpuSurface,
    /// Changes that exported maps have.
    pub exported: Exported<'a>,
}

impl ShownMaps<'_> {
    /// Returns the maps of a material of a run, with the changes that exported maps have. They remain valid after the run.
    /// With a cache, only maps that have changed are computed again.
    pub fn material(
        &self,
        run: &mut Run,
        slots: MaterialSlots,
        options: &RunOptions<'_>,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<DeviceMaps, GpuError> {
        let mut maps = Vec::new();
        for (channel, slot) in slots.stored() {
            if let Some(slot) = slot {
                maps.push(stored_map(self.surface, run, slot, Plane::Material(channel))?);
            }
        }
        let is_flat = slots.height.is_none() && slots.slope.is_none();
        if !is_flat {
            maps.push({
                let normals = Normals {
                    gpu: self.gpu,
                    surface: self.surface,
                    height: slots.height,
                    slope: slots.slope,
                    options,
                };
                shown_normals(normals, run, cache.as_deref_mut())?
            });
        }
        if let Some(slot) = slots.anisotropy {
            maps.push(ShownMap {
                texture: anisotropy_texture(self.gpu, self.surface, run, slot, options)?,
                made: None,
                kind: BorderKind::of(Plane::Material(Stored::Anisotropy)),
                mean: Mean::Plain,
                is_spare: true,
            });
        }
        let mut shown = self.maps(run, maps, cache)?.into_iter();
        // The order is that of the fields above.
        let [color, surface, emission, height, coat, sheen, subsurface] =
            slots.stored().map(|(_, slot)| slot.and_then(|_| shown.next()));
        Ok(DeviceMaps {
            color,
            surface,
            emission,
            height,
            normal: if is_flat { None } else { shown.next() },
            coat,
            anisotropy: slots.anisotropy.and_then(|_| shown.next()),
            sheen,
            subsurface,
        })
    }

    /// Returns the texture of a plane of a result that the plan kept, with the changes that exported maps have. With a
    /// cache, a copy is kept there.
    pub fn plane(
        &self,
        run: &mut Run,
        slot: SlotRef,
        plane: Plane,
        cache: Option<&mut ResultCache>,
    ) -> Result<wgpu::Texture, GpuError> {
        let map = stored_map(self.surface, run, slot, plane)?;
        let shown = self.maps(run, vec![map], cache)?.pop();
        shown.ok_or_else(|| GpuError::Defect("a map was not shown".into()))
    }

    /// Returns the textures of maps as they are shown. A map that equals its exported map is shown without a copy. Copies
    /// of other maps are kept in a cache, and only changed tiles are copied again.
    fn maps(
        &self,
        run: &mut Run,
        maps: Vec<ShownMap>,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<Vec<wgpu::Texture>, GpuError> {
        let exported = self.exported;
        if let (Some(borders), true) = (exported.borders, exported.changes_results) {
            for map in &maps {
                borders.repeat_charts(self.gpu, self.surface, [&map.texture; 2], map.kind)?;
            }
            let maps = maps.into_iter();
            let shown = maps.map(|map| self.map(run, map, None, None));
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
                borders.find_jumps(self.gpu, self.surface, &asked)?
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
                    self.map(run, map, borders, cache.as_deref_mut())?
                }
            });
        }
        Ok(shown)
    }

    /// Returns the texture of a map as it is shown. With `borders`, its ghosts beyond a jump repeat their chart.
    fn map(
        &self,
        run: &mut Run,
        map: ShownMap,
        borders: Option<&Borders>,
        mut cache: Option<&mut ResultCache>,
    ) -> Result<wgpu::Texture, GpuError> {
        if let (Some(cache), Some(made)) = (cache.as_deref_mut(), &map.made) {
            cache.put_jumps(made.key, borders.is_some());
        }
        let (gpu, surface, shares) = (self.gpu, self.surface, self.exported.shares);
        if shares.is_none() && borders.is_none() {
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
        let bordered = match (shares, borders) {
            (Some(_), Some(borders)) => {
                let bordered = self.copy(run, &map.texture)?;
                borders.repeat_charts(gpu, surface, [&map.texture, &bordered], map.kind)?;
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
            None => self.copy(run, source)?,
        };
        match (shares, borders) {
            (Some(shares), _) => shares.apply(gpu, surface, [source, &shown], map.mean)?,
            (None, Some(borders)) => borders.repeat_charts(gpu, surface, [source, &shown], map.kind)?,
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
    fn copy(&self, run: &mut Run, texture: &wgpu::Texture) -> Result<wgpu::Texture, GpuError> {
        let format: Format = format_of(texture)?;
        let copy = run.pool.take(self.gpu, format, self.surface.extent)?;
        run.report.pool = run.pool.report();
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_texture_to_texture(texture.as_image_copy(), copy.as_image_copy(), texture.size());
        self.gpu.queue.submit([encoder.finish()]);
        Ok(copy)
    }

    fn copy_tiles(&self, from: &wgpu::Texture, to: &wgpu::Texture, tiles: &TileSet) {
        let mut encoder = self
            .gpu
            .device
            .create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        for place in tiles.places() {
            encoder.copy_texture_to_texture(copied_tile(from, place), copied_tile(to, place), TILE_EXTENT);
        }
        self.gpu.queue.submit([encoder.finish()]);
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

/// Computes the normals of height and slope, to be shown.
fn shown_normals(normals: Normals<'_>, run: &mut Run, cache: Option<&mut ResultCache>) -> Result<ShownMap, GpuError> {
    let is_spare = cache.is_none();
    let texture = match cache {
        Some(cache) => normals.kept(run, cache)?,
        None => normals.texture(run)?,
    };
    // Normals depend on the heights around them, and their ghosts on the texels around those.
    let made = MadeMap::of(run, "shown normals", &normals.slots());
    let made = made.map(|made| made.grown(normals.surface).grown(normals.surface));
    Ok(ShownMap {
        texture,
        made,
        kind: BorderKind::of(Plane::Vector),
        mean: Mean::Unit,
        is_spare,
    })
}

/// A plane of a result that is shown.
fn stored_map(surface: &GpuSurface, run: &Run, slot: SlotRef, plane: Plane) -> Result<ShownMap, GpuError> {
    Ok(ShownMap {
        texture: run.texture(slot)?,
        // Ghosts depend on the texels of their chart around them.
        made: MadeMap::of(run, "shown", &[Some(slot)]).map(|made| made.grown(surface)),
        kind: BorderKind::of(plane),
        mean: Mean::Plain,
        is_spare: false,
    })
}
