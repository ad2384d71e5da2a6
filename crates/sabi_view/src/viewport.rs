//! Viewport: a picture that is refined over several frames while its inputs stay the same.

use std::sync::Arc;

use sabi_gpu::{AdapterKind, Gpu};

use crate::error::ViewError;
use crate::renderer::{MissingPipelines, Prepared, Renderer, Sample};
use crate::scene::{Scene, Shot};
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

    /// Draws the first sample of a picture whose inputs changed, else the next sample if any is missing. `revision` identifies
    /// the scene. Returns true if it drew, after which more samples may be missing; nothing is drawn for a size without area.
    pub fn show(
        &mut self,
        gpu: &Gpu,
        scene: &Scene<'_>,
        revision: u64,
        shot: &Shot,
        size: [u32; 2],
        is_moving: bool,
    ) -> Result<bool, ViewError> {
        if size.contains(&0) {
            return Ok(false);
        }
        let divisor = if is_moving {
            self.quality.moving_divisor.max(1)
        } else {
            1
        };
        let inputs = PictureInputs {
            shot: Shot {
                samples: if is_moving { 1 } else { shot.samples.max(1) },
                ..self.reduced(shot)
            },
            size: size.map(|side| side.div_ceil(divisor)),
            revision,
        };
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
            progress.samples += 1;
        }
        self.target = Some(target);
        self.progress = Some(progress);
        Ok(is_unfinished)
    }
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
