//! Ray steps: results from disk, from cached hits, or by casting rays.

use sabi_plan::{KernelStep, Level, StepRays};

use super::Runner;
use super::dispatch::BoundTextures;
use crate::blocks::block_buffer;
use crate::error::GpuError;
use crate::pipeline_cache::CompiledKernel;
use crate::rays::{Hits, RayBuffers, RayPass, RayScene, caster, casts_on_device};
use crate::readback::read_texture;
use crate::source_fill::SourceFill;
use crate::tiles::Slices;

/// Returns the scene for rays. It is built when the first rays are cast.
fn scene(sources: &mut dyn SourceFill) -> Result<RayScene<'_>, GpuError> {
    sources.scene().map_err(GpuError::Scene)
}

impl Runner<'_> {
    pub(super) fn rays(
        &mut self,
        step: &KernelStep,
        rays: &StepRays,
        compiled: &CompiledKernel,
        ray_generation: &wgpu::ComputePipeline,
        bound: &BoundTextures,
        slices: &Slices<'_>,
        sources: &mut dyn SourceFill,
    ) -> Result<(), GpuError> {
        let is_cached_on_disk = self.options.hits == Hits::Cast && sources.caches_rays();
        let key = is_cached_on_disk.then(|| self.disk_key(step, rays, compiled, bound));
        if let Some(found) = key.and_then(|key| sources.cached_rays(&key))
            && self.upload_results(step.level, bound, &found)?
        {
            self.found_on_disk.extend(step.nodes.iter().cloned());
            return Ok(());
        }
        let buffers = RayBuffers::new(self.gpu, rays)?;
        let groups = |reach| {
            let block = block_buffer(self.gpu, compiled, step, reach);
            [0, 1].map(|set| {
                let block = std::iter::once(block.as_entire_binding());
                let resources = block.chain(bound.resources()).chain(buffers.bindings(set));
                self.gpu.bind(&compiled.layout, resources)
            })
        };
        let pass = RayPass {
            slices,
            generation: ray_generation,
            evaluation: &compiled.pipeline,
            groups: groups(None),
            first_tiles: compiled.pace.first_tiles() as usize,
            is_canceled: self.options.is_canceled,
        };
        self.warm(compiled, slices, &pass.groups[0])?;
        let (gpu, choice) = (self.gpu, self.options.caster);
        let key_of_hits = rays.key.map(|key| self.key_of_hits(key));
        match self.hit_cache.as_deref_mut().zip(key_of_hits) {
            Some((hit_cache, key)) if hit_cache.fits(slices.tile_count() as usize, rays.count) => {
                if !hit_cache.contains(&key) {
                    // The hits are also used for other angles, so none is left out.
                    let mut caster = caster(gpu, choice, scene(sources)?, buffers.cast_rays(None))?;
                    hit_cache.insert(key, buffers.cast_longest(&pass, &groups(rays.reach), &mut caster)?);
                }
                buffers.evaluate_cached(&pass, hit_cache.get(&key))?;
                self.report.has_cached_hits = true;
            }
            _ => {
                let counting = buffers.cast_rays(rays.least_turn);
                buffers.run(&pass, &mut caster(gpu, choice, scene(sources)?, counting)?)?;
            }
        }
        if let Some(key) = key {
            sources.cache_rays(&key, &self.read_results(step.level, bound)?);
        }
        Ok(())
    }

    /// Returns the key of the hits of rays. Hits are cached in slices of the tiles that a step computes, so the tiles are part of it.
    fn key_of_hits(&self, key: [u8; 32]) -> [u8; 32] {
        let Some(tiles) = self.coverages.key(self.at) else {
            return key;
        };
        let mut hash = blake3::Hasher::new_derive_key("sabi hits of rays in some tiles");
        hash.update(&key).update(&tiles);
        *hash.finalize().as_bytes()
    }

    /// Returns the key under which a step stores its results on disk: content keys of the results, the kernel text, and
    /// everything that may change rounding.
    fn disk_key(
        &self,
        step: &KernelStep,
        rays: &StepRays,
        compiled: &CompiledKernel,
        bound: &BoundTextures,
    ) -> [u8; 32] {
        let mut hash = blake3::Hasher::new_derive_key("sabi results of rays");
        let mut part = |bytes: &[u8]| {
            hash.update(&(bytes.len() as u64).to_le_bytes());
            hash.update(bytes);
        };
        let adapter = self.gpu.summary();
        let is_on_device = casts_on_device(self.gpu, self.options.caster);
        part(env!("CARGO_PKG_VERSION").as_bytes());
        part(compiled.kernel.module.wgsl().as_bytes());
        part(adapter.name.as_bytes());
        part(adapter.driver.as_bytes());
        part(&[u8::from(is_on_device), bound.written.len() as u8]);
        part(&step.level.bytes());
        if let Some(tiles) = self.coverages.key(self.at) {
            part(&tiles);
        }
        for key in &rays.results {
            part(key);
        }
        *hash.finalize().as_bytes()
    }

    /// Uploads results from disk. Returns false if their size does not match.
    fn upload_results(&self, level: Level, bound: &BoundTextures, found: &[u8]) -> Result<bool, GpuError> {
        let surface = self.surfaces.at(level)?;
        let texels = surface.texels();
        let sizes = bound.written.iter().map(|(_, format)| texels * format.texel_bytes());
        if sizes.clone().sum::<u64>() != found.len() as u64 {
            return Ok(false);
        }
        let mut rest = found;
        for ((texture, format), size) in bound.written.iter().zip(sizes) {
            let (plane, others) = rest.split_at(size as usize);
            self.upload(texture, *format, surface.extent, plane);
            rest = others;
        }
        Ok(true)
    }

    /// Reads back the results of a kernel, to store them on disk.
    fn read_results(&self, level: Level, bound: &BoundTextures) -> Result<Vec<u8>, GpuError> {
        let extent = self.surfaces.at(level)?.extent;
        let mut bytes = Vec::new();
        for (texture, format) in &bound.written {
            let plane = read_texture(self.gpu, texture, extent, *format)?;
            bytes.extend_from_slice(plane.bytes());
        }
        Ok(bytes)
    }
}
