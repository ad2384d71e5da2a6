//! Viewport: a picture that is refined over several frames while its inputs stay the same.

use std::sync::Arc;

use glam::Vec3;
use sabi_gpu::{AdapterKind, Gpu};

use crate::error::ViewError;
use crate::renderer::{MissingPipelines, Part, Prepared, Renderer, Sample};
use crate::scene::{Mode, Scene, Shot};
use crate::target::Target;

/// Limits of the work for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// True if relief is drawn when a shot asks for it.
    pub follows_relief: bool,
    /// Factor by which each side of the picture is reduced while something moves.
    pub moving_divisor: u32,
}

impl Quality {
    /// Limits that suit an adapter.
    pub fn of(kind: AdapterKind) -> Quality {
        match kind {
            AdapterKind::Discrete | AdapterKind::Integrated => Quality {
                follows_relief: true,
                moving_divisor: 1,
            },
            AdapterKind::Cpu => Quality {
                follows_relief: false,
                moving_divisor: 2,
            },
        }
    }

    /// Remark for the artist about reduced quality; `None` at full quality.
    pub fn remark(self) -> Option<&'static str> {
        (!self.follows_relief || self.moving_divisor > 1).then_some(
            "The viewport runs without a graphics card: relief is shown by the normal map alone, and the picture is coarser \
             while something moves.",
        )
    }
}

/// Inputs of a picture.
#[derive(Clone, Debug, PartialEq)]
struct PictureInputs {
    shot: Shot,
    size: [u32; 2],
    revision: u64,
}

/// Progress of the last picture.
struct PictureProgress {
    inputs: PictureInputs,
    prepared: Prepared,
    /// Number of samples drawn.
    samples: u32,
    /// True if what the pixels show of the model is that of the first sample.
    shows_first: bool,
}

/// A scene, told apart from others.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneRevision {
    /// Identifies the scene.
    pub number: u64,
    /// Earlier scenes of the same model by their numbers, each with the corners of boxes in view space outside of which this one
    /// looks the same.
    pub changed: Vec<(u64, Vec<[Vec3; 2]>)>,
}

/// Picture on the device that is drawn again when its inputs change, and refined sample by sample while they stay the same.
pub struct Viewport {
    renderer: Arc<Renderer>,
    /// Limits of the work for a picture.
    pub quality: Quality,
    target: Option<Target>,
    progress: Option<PictureProgress>,
}

impl Viewport {
    /// A viewport without a picture, with the quality that suits the adapter; several may share a renderer.
    pub fn new(gpu: &Gpu, renderer: Arc<Renderer>) -> Viewport {
        Viewport {
            renderer,
            quality: Quality::of(gpu.summary().kind),
            target: None,
            progress: None,
        }
    }

    /// Returns the pipelines to make before [`Viewport::show`] key this without a delay.
    pub fn missing(&self, scene: &Scene<'_>, shot: &Shot) -> Option<MissingPipelines> {
        self.renderer.missing(scene, &self.reduced(shot))
    }

    /// The shot without features that the quality leaves out.
    fn reduced(&self, shot: &Shot) -> Shot {
        Shot {
            has_relief: shot.has_relief && self.quality.follows_relief,
            ..shot.clone()
        }
    }

    /// The picture; none before the first one.
    pub fn picture(&self) -> Option<&Target> {
        self.target.as_ref()
    }

    /// Draws the first sample of a picture whose inputs changed, else the next sample if any is missing. While something moves, only
    /// the part of the last picture is drawn again in which the scene has changed, if that is known. Returns true if it drew, after
    /// which more samples may be missing; nothing is drawn for a size without area.
    pub fn show(
        &mut self,
        gpu: &Gpu,
        scene: &Scene<'_>,
        revision: &SceneRevision,
        shot: &Shot,
        size: [u32; 2],
        is_moving: bool,
    ) -> Result<bool, ViewError> {
        if size.contains(&0) {
            return Ok(false);
        }
        let inputs = self.inputs(revision.number, shot, size, is_moving);
        if is_moving && let Some(drawn) = self.show_part(gpu, scene, revision, &inputs, size)? {
            return Ok(drawn);
        }
        let mut target = match self.target.take().filter(|target| target.size() == inputs.size) {
            Some(target) => target,
            None => Target::new(gpu, inputs.size)?,
        };
        // A failure must not leave an older picture that looks current.
        let mut progress = match self.progress.take() {
            Some(progress) if progress.inputs == inputs => progress,
            before => PictureProgress {
                prepared: {
                    let before = before.map(|before| before.prepared);
                    self.renderer.prepare(gpu, &target, scene, &inputs.shot, before)?
                },
                samples: 0,
                shows_first: false,
                inputs,
            },
        };
        let shot = &progress.inputs.shot;
        let is_unfinished = progress.samples < shot.samples;
        if is_unfinished {
            let sample = Sample {
                number: progress.samples,
                is_shown: true,
            };
            self.renderer
                .add_sample(gpu, &mut target, scene, shot, &mut progress.prepared, sample)?;
            progress.shows_first = progress.samples == 0;
            progress.samples += 1;
        }
        self.target = Some(target);
        self.progress = Some(progress);
        Ok(is_unfinished)
    }

    /// Inputs of a picture of the whole scene: coarser and of a single sample while something moves.
    fn inputs(&self, revision: u64, shot: &Shot, size: [u32; 2], is_moving: bool) -> PictureInputs {
        let divisor = if is_moving {
            self.quality.moving_divisor.max(1)
        } else {
            1
        };
        PictureInputs {
            shot: Shot {
                samples: if is_moving { 1 } else { shot.samples.max(1) },
                ..self.reduced(shot)
            },
            size: size.map(|side| side.div_ceil(divisor)),
            revision,
        }
    }

    /// Draws the part of the last picture in which the scene has changed. Returns whether there was any; none where the last picture
    /// is another one, or where it is not known what has changed.
    fn show_part(
        &mut self,
        gpu: &Gpu,
        scene: &Scene<'_>,
        revision: &SceneRevision,
        inputs: &PictureInputs,
        size: [u32; 2],
    ) -> Result<Option<bool>, ViewError> {
        let (Some(progress), Some(target)) = (&self.progress, &self.target) else {
            return Ok(None);
        };
        let before = &progress.inputs;
        let is_same_view = progress.samples > 0
            && target.size() == before.size
            && (before.size == size || before.size == inputs.size)
            && looks_alike(&before.shot, &inputs.shot);
        if !is_same_view {
            return Ok(None);
        }
        if before.revision == revision.number {
            return Ok(Some(false));
        }
        let Some(parts) = changed_parts(scene, revision, before, &inputs.shot) else {
            return Ok(None);
        };
        let inputs = PictureInputs {
            size: before.size,
            ..inputs.clone()
        };
        let (Some(before), Some(mut target)) = (self.progress.take(), self.target.take()) else {
            return Ok(None);
        };
        let mut prepared = self
            .renderer
            .prepare(gpu, &target, scene, &inputs.shot, Some(before.prepared))?;
        let is_rastered = before.shows_first;
        self.renderer.draw_part(
            gpu,
            &mut target,
            scene,
            &inputs.shot,
            &mut prepared,
            &parts,
            is_rastered,
        )?;
        self.target = Some(target);
        self.progress = Some(PictureProgress {
            inputs,
            prepared,
            samples: 1,
            shows_first: true,
        });
        Ok(Some(true))
    }
}

/// Parts of the last picture in which a scene has changed; none where that is not known.
fn changed_parts(
    scene: &Scene<'_>,
    revision: &SceneRevision,
    before: &PictureInputs,
    shot: &Shot,
) -> Option<Vec<Part>> {
    // Relief shifts what is seen, and clear places show what lies behind them.
    let is_plain = !shot.has_relief && scene.looks.iter().all(|look| look.is_opaque);
    let known = revision.changed.iter().find(|(number, _)| *number == before.revision);
    let (_, bounds) = known.filter(|_| is_plain)?;
    let parts = bounds
        .iter()
        .map(|corners| shot.camera.part_of_picture(*corners, before.size));
    parts.collect()
}

/// Returns true if two shots look alike but for their samples.
fn looks_alike(shot: &Shot, other: &Shot) -> bool {
    // The range of heights is that of the scene, and shows in pictures of the height and in relief alone.
    let shows_range = shot.mode != Mode::Material || shot.has_relief;
    let height_range = if shows_range {
        shot.height_range
    } else {
        other.height_range
    };
    Shot {
        samples: other.samples,
        height_range,
        ..shot.clone()
    } == *other
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_software_driver_gets_less_and_says_so() {
        for kind in [AdapterKind::Discrete, AdapterKind::Integrated] {
            assert_eq!(Quality::of(kind).remark(), None);
        }
        let less = Quality::of(AdapterKind::Cpu);
        assert!(!less.follows_relief && less.moving_divisor == 2);
        assert!(
            less.remark()
                .is_some_and(|words| words.contains("without a graphics card"))
        );
    }
}
