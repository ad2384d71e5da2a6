//! Running a plan step by step, in submissions short enough to be interrupted.

mod dispatch;
mod kept;
mod rays;
mod source;
mod written_over;

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;
use std::time::{Duration, Instant};

use sabi_nodes::Library;
use sabi_nodes::link::{Domain, Format, SURVEY_GROUPS};
use sabi_plan::{KernelStep, MoveStep, Plan, SlotExtent, SlotRef, Step};

use self::kept::{KeptResults, kept_slots};
use crate::blocks::block_buffer;
use crate::cache::ResultCache;
use crate::changes::{Changes, PartialStep};
use crate::coverage::Coverages;
use crate::device::Gpu;
use crate::error::GpuError;
use crate::ghosts::FillRound;
use crate::levels::{PlaneMove, Surfaces};
use crate::needed_steps::{
    dead_after, free_after_first_run, last_of_kernels, most_alive, needed_steps, reads, written_by,
};
use crate::pipeline_cache::CompiledKernel;
use crate::pipelines::node_kernel;
use crate::pool::{TexturePool, bytes_of, texture};
use crate::rays::{HitCache, Hits};
use crate::run_options::RunOptions;
use crate::run_result::{Run, RunReport, StepTime};
use crate::source_fill::SourceFill;
use crate::survey::{BINS, survey};
use crate::tile_set::TileSet;
use crate::waiting::Patience;

/// Run of a repeated kernel.
#[derive(Clone, Copy)]
struct Repetition {
    index: u32,
    count: u32,
}

impl Repetition {
    /// Returns the rounds that fill ghosts. The ghosts of the repetition before the last are still in the texture, but they are not used
    /// as a first estimate: values may change their sign from one repetition to the next, like the polynomials of a blur.
    ///
    /// Only results are interpolated cubically. Textures between the passes of a filter may hold distances, which must not
    /// become shorter than a path on the surface.
    fn fill_rounds(self, is_result: bool) -> &'static [FillRound] {
        FillRound::sequence(is_result && self.index + 1 == self.count)
    }
}

/// Runs a plan. With a cache, steps whose results are cached are skipped and new results are cached. Without one,
/// results that `sources` keeps are not computed; in that case no slot of the plan may be reused for a second result.
pub fn run_plan(
    gpu: &Gpu,
    surfaces: Surfaces<'_>,
    library: &Library,
    plan: &Plan,
    options: &RunOptions<'_>,
    sources: &mut dyn SourceFill,
    cache: Option<&mut ResultCache>,
) -> Result<Run, GpuError> {
    let kept = match cache {
        None if sources.keeps_results() => kept_slots(gpu, plan, options, sources),
        _ => BTreeSet::new(),
    };
    if !kept.is_empty() {
        match run_with(gpu, surfaces, library, plan, options, sources, None, kept) {
            // The kept result was removed or is damaged, so everything is computed.
            Err(GpuError::ResultGone) => {}
            run => return run,
        }
    }
    run_with(gpu, surfaces, library, plan, options, sources, cache, BTreeSet::new())
}

/// Runs a plan, given known results: in a cache, or in slots whose results are kept elsewhere.
fn run_with(
    gpu: &Gpu,
    surfaces: Surfaces<'_>,
    library: &Library,
    plan: &Plan,
    options: &RunOptions<'_>,
    sources: &mut dyn SourceFill,
    mut cache: Option<&mut ResultCache>,
    kept: BTreeSet<SlotRef>,
) -> Result<Run, GpuError> {
    gpu.wait_for_overrun(options.is_canceled)?;
    let started = Instant::now();
    let coverages = Coverages::of(plan, options.shown);
    let keys = coverages.slot_keys(plan);
    let cached = cache.as_ref().map_or_else(BTreeMap::new, |cache| cache.find(&keys));
    let keeps_all = cache.is_some();
    let known = cached.keys().copied().chain(kept.iter().copied()).collect();
    let steps = needed_steps(plan, &known);
    let mut changes = match cache.as_deref_mut() {
        Some(cache) if !steps.is_empty() => Changes::find(plan, &coverages, &steps, &keys, cache, sources),
        _ => Changes::default(),
    };
    let hit_cache = cache
        .as_deref_mut()
        .map(|cache| &mut cache.hits)
        .filter(|_| options.hits == Hits::Cached);
    let mut runner = Runner::new(gpu, surfaces, library, plan, options, coverages, hit_cache);
    runner.take_known(&steps, cached, std::mem::take(&mut changes.parts));
    if !keeps_all && sources.keeps_results() {
        runner.kept = Some(KeptResults::new(keys.clone(), kept));
    }
    let ended = runner.run(&steps, sources, !keeps_all);
    if matches!(ended, Err(GpuError::Canceled)) && gpu.wait_with(Patience::for_a_moment()).is_ok() {
        runner.done = runner.report.steps.len();
    }
    let (done, textures, pool, mut report) = runner.into_results();
    report.run = started.elapsed().saturating_sub(report.compile);
    if let Some(cache) = cache
        && !report.has_cached_hits
        && !matches!(ended, Err(GpuError::Lost(_)))
    {
        // Results of finished steps are cached even if a later step failed or was canceled.
        let unfinished = written_by(plan, &steps[done..]);
        let finished = keys
            .iter()
            .filter(|(slot, _)| !unfinished.contains(slot))
            .map(|(slot, key)| (*slot, *key));
        cache.insert(&finished.collect(), &textures, plan, surfaces.finest.texels());
        if ended.is_ok() {
            cache.remember(plan);
        }
    }
    ended.map(|()| Run {
        textures,
        report,
        pool,
        keys,
        changed: changes.results,
    })
}

/// State of a run.
struct Runner<'a> {
    gpu: &'a Gpu,
    surfaces: Surfaces<'a>,
    library: &'a Library,
    plan: &'a Plan,
    options: &'a RunOptions<'a>,
    textures: Vec<Option<wgpu::Texture>>,
    pool: TexturePool,
    report: RunReport,
    /// One-texel textures for unused planes of interactive kernels, by format and by whether they are written: a texture
    /// must not be read and written in the same dispatch.
    unused_planes: BTreeMap<(Format, bool), wgpu::Texture>,
    /// Cached ray hits, if they may be used.
    hit_cache: Option<&'a mut HitCache>,
    /// Nodes whose results were read from disk.
    found_on_disk: Vec<String>,
    /// Results that are kept elsewhere, if there are any.
    kept: Option<KeptResults>,
    /// Number of steps that the device has finished without an error, as far as known.
    done: usize,
    /// Tiles of the steps that compute only some tiles, by step index. Other steps compute all tiles.
    parts: BTreeMap<usize, TileSet>,
    /// Tiles of the present step if it computes only some.
    part: Option<TileSet>,
    /// Tiles to which each step is limited.
    coverages: Coverages<'a>,
    /// Index of the present step.
    at: usize,
    /// Slots whose textures are free after each step; empty if all results are cached.
    dead_after: BTreeMap<usize, BTreeSet<SlotRef>>,
    /// Steps after which their kernels are forgotten.
    last_of_kernels: BTreeSet<usize>,
}

/// Returns true if a step is a kernel over tiles. The run does not wait for such kernels if they are quick.
fn is_of_tiles(step: &Step) -> bool {
    matches!(step, Step::Kernel(kernel) if kernel.rays.is_none() && !matches!(kernel.spec.domain, Domain::Once | Domain::Groups))
}

impl<'a> Runner<'a> {
    fn new(
        gpu: &'a Gpu,
        surfaces: Surfaces<'a>,
        library: &'a Library,
        plan: &'a Plan,
        options: &'a RunOptions<'a>,
        coverages: Coverages<'a>,
        hit_cache: Option<&'a mut HitCache>,
    ) -> Runner<'a> {
        Runner {
            gpu,
            surfaces,
            library,
            plan,
            options,
            textures: plan.slots.iter().map(|_| None).collect(),
            pool: TexturePool::new(options.budget, surfaces.finest.texture_bytes()),
            report: RunReport::default(),
            unused_planes: BTreeMap::new(),
            hit_cache,
            found_on_disk: Vec::new(),
            kept: None,
            done: 0,
            parts: BTreeMap::new(),
            part: None,
            coverages,
            at: 0,
            dead_after: BTreeMap::new(),
            last_of_kernels: BTreeSet::new(),
        }
    }

    /// Returns the parts that remain of a run: the number of finished steps, the textures of slots, the pool, and the report.
    fn into_results(self) -> (usize, Vec<Option<wgpu::Texture>>, TexturePool, RunReport) {
        let report = RunReport {
            found_on_disk: self.found_on_disk,
            kept_results: self.kept.map(KeptResults::into_nodes).unwrap_or_default(), // Empty if no results are kept elsewhere.
            pool: self.pool.report(),
            ..self.report
        };
        (self.done, self.textures, self.pool, report)
    }

    /// Takes over cached results, and the textures that steps change in part.
    fn take_known(
        &mut self,
        steps: &[usize],
        cached: BTreeMap<SlotRef, wgpu::Texture>,
        parts: BTreeMap<usize, PartialStep>,
    ) {
        // A cached texture may be on screen, so a step that runs again writes to another texture.
        let rewritten = written_by(self.plan, steps);
        for (slot, texture) in cached {
            self.textures[slot] = (!rewritten.contains(&slot)).then_some(texture);
        }
        for (at, part) in parts {
            for (slot, texture) in part.textures {
                self.textures[slot] = Some(texture);
            }
            self.parts.insert(at, part.tiles);
        }
    }
}

impl Runner<'_> {
    /// Runs steps in order. With `releases`, textures return to the pool after their last use.
    fn run(&mut self, steps: &[usize], sources: &mut dyn SourceFill, releases: bool) -> Result<(), GpuError> {
        if releases {
            self.dead_after = dead_after(self.plan, steps);
            self.pool.aim_at(self.most_alive_bytes(steps));
        }
        if self.options.forgets_kernels {
            self.last_of_kernels = last_of_kernels(self.plan, steps);
        }
        for (done, at) in steps.iter().enumerate() {
            self.at = *at;
            self.part = self.parts.remove(at);
            self.report.steps_in_part += usize::from(self.part.is_some());
            let step = &self.plan.steps[*at];
            self.load_kept(&reads(step), sources)?;
            self.step(step, sources)?;
            self.keep_results(step, sources)?;
            if self.gpu.in_flight.is_empty() {
                self.done = done + 1;
            }
            self.release_after(*at);
            (self.options.progress)(done + 1, steps.len());
        }
        let results: Vec<SlotRef> = self
            .plan
            .results
            .iter()
            .flat_map(|result| &result.slots)
            .copied()
            .collect();
        self.load_kept(&results, sources)?;
        self.wait()?;
        self.done = steps.len();
        Ok(())
    }

    /// Waits for all submitted work, unless the run is canceled.
    fn wait(&self) -> Result<(), GpuError> {
        self.gpu.wait_with(Patience::for_slice(self.options.is_canceled))
    }

    fn step(&mut self, step: &Step, sources: &mut dyn SourceFill) -> Result<(), GpuError> {
        if (self.options.is_canceled)() {
            return Err(GpuError::Canceled);
        }
        let started = Instant::now();
        let compile_before = self.report.compile;
        let mut taken = None;
        if !is_of_tiles(step) {
            // Work that was submitted earlier must not count in the time of this step.
            self.wait()?;
        }
        let nodes = match step {
            Step::Source(source) => {
                self.source(source, sources)?;
                vec![(source.id.clone(), 1.0)]
            }
            Step::Move(step) => {
                self.move_plane(step)?;
                vec![(step.node.clone(), 1.0)]
            }
            Step::Survey(step) => {
                let [from, to] = [self.texture(step.from)?, self.texture(step.to)?];
                survey(self.gpu, self.surfaces.finest, step.each, [&from, &to], self.options)?;
                vec![(step.node.clone(), 1.0)]
            }
            Step::Kernel(kernel) => {
                let run = self.kernel(kernel, sources);
                taken = run.map_err(|error| error.of_nodes(&kernel.nodes))?;
                kernel
                    .nodes
                    .iter()
                    .cloned()
                    .zip(kernel.cost_shares.iter().copied())
                    .collect()
            }
        };
        let run = match taken {
            Some(taken) => taken,
            None => {
                self.wait()?;
                let compiled = self.report.compile - compile_before;
                started.elapsed().saturating_sub(compiled)
            }
        };
        self.report.steps.push(StepTime { nodes, run });
        Ok(())
    }

    fn texture(&mut self, slot: SlotRef) -> Result<wgpu::Texture, GpuError> {
        if let Some(texture) = &self.textures[slot] {
            return Ok(texture.clone());
        }
        let format = self.plan.slots[slot].format;
        let extent = self.extent(slot)?;
        if self.pool.make_room(format, extent) {
            // The memory of dropped textures becomes free only when the device no longer uses them.
            self.wait()?;
        }
        let texture = self.pool.take(self.gpu, format, extent)?;
        self.textures[slot] = Some(texture.clone());
        Ok(texture)
    }

    /// Returns the size of a slot in texels.
    fn extent(&self, slot: SlotRef) -> Result<[u32; 3], GpuError> {
        Ok(match self.plan.slots[slot].extent {
            SlotExtent::Level(level) => self.surfaces.at(level)?.extent,
            SlotExtent::Survey => [BINS, 1, 1],
            SlotExtent::GroupSurvey => [BINS, SURVEY_GROUPS, 1],
            SlotExtent::Single => [1, 1, 1],
            SlotExtent::Groups => [SURVEY_GROUPS, 1, 1],
        })
    }

    /// Returns the largest number of bytes of textures that these steps need at the same time.
    fn most_alive_bytes(&self, steps: &[usize]) -> u64 {
        let bytes = |slot: SlotRef| {
            let extent = self.extent(slot);
            // The step that runs on a missing level reports it.
            extent.map_or(0, |extent| bytes_of(self.plan.slots[slot].format, extent))
        };
        most_alive(self.plan, steps, &self.dead_after, self.options.writes_over_from, bytes)
    }

    /// Returns textures to the pool if no later step reads them.
    fn release_after(&mut self, at: usize) {
        for slot in self.dead_after.remove(&at).into_iter().flatten() {
            self.release(slot);
        }
    }

    /// Returns the texture of a slot to the pool.
    fn release(&mut self, slot: SlotRef) {
        if let Some(texture) = self.textures[slot].take() {
            self.pool.release(self.plan.slots[slot].format, texture);
        }
    }

    fn unused_plane(&mut self, format: Format, is_written: bool) -> Result<wgpu::Texture, GpuError> {
        if let Some(texture) = self.unused_planes.get(&(format, is_written)) {
            return Ok(texture.clone());
        }
        let made = texture(self.gpu, [1, 1, 1], format)?;
        self.unused_planes.insert((format, is_written), made.clone());
        Ok(made)
    }

    /// Runs a kernel as often as it is repeated. Returns the time that it takes, if it is known.
    fn kernel(&mut self, step: &KernelStep, sources: &mut dyn SourceFill) -> Result<Option<Duration>, GpuError> {
        let compiling = Instant::now();
        let compiled = node_kernel(self.gpu, &step.spec, self.library, &step.nodes)?;
        self.report.compile += compiling.elapsed();
        let block = block_buffer(self.gpu, &compiled, step, None);
        let over = self.slots_written_over(step);
        if !over.is_empty() {
            let taken = self.kernel_over(step, &compiled, &block, &over)?;
            self.forget_kernel(&compiled);
            return Ok(Some(taken));
        }
        let run_count = step.feedback.as_ref().map_or(1, |feedback| feedback.run_count);
        let dead = self.dead_after.get(&self.at);
        let free_after_first = dead.and_then(|dead| free_after_first_run(step, dead));
        let mut last: Option<SlotRef> = None;
        let mut sum = Some(Duration::ZERO);
        for index in 0..run_count {
            let mut reads = step.reads.clone();
            let mut writes = step.writes.clone();
            if let Some(feedback) = &step.feedback {
                if let Some(last) = last {
                    reads[feedback.read] = Some(last);
                }
                // Slots alternate so that the last repetition writes the slot of the result.
                if !(run_count - 1 - index).is_multiple_of(2) {
                    writes[0] = Some(feedback.scratch);
                }
                last = writes[0];
            }
            let slots = [reads.as_slice(), &writes];
            let repetition = Repetition {
                index,
                count: run_count,
            };
            let taken = self.dispatch(step, &compiled, &block, slots, repetition, sources)?;
            sum = sum.zip(taken).map(|(sum, taken)| sum + taken);
            if let Some(start) = free_after_first.filter(|_| index == 0) {
                self.release(start);
            }
        }
        self.forget_kernel(&compiled);
        Ok(sum)
    }

    /// Forgets the kernel of the present step if no later step uses it.
    fn forget_kernel(&self, compiled: &Arc<CompiledKernel>) {
        if self.last_of_kernels.contains(&self.at) {
            self.gpu.pipelines.forget_kernel(compiled);
        }
    }

    fn move_plane(&mut self, step: &MoveStep) -> Result<(), GpuError> {
        let [from, to] = [self.texture(step.from)?, self.texture(step.to)?];
        let moving = PlaneMove {
            gpu: self.gpu,
            surfaces: self.surfaces,
            step,
            source: &from,
            target: &to,
            options: self.options,
        };
        moving.run()
    }
}
