//! Viewport: a picture that is refined over several frames while its inputs do not change.

use std::sync::Arc;

use glam::Vec3;
use sabi_gpu::{AdapterKind, Gpu};

use crate::error::ViewError;
use crate::render_target::RenderTarget;
use crate::renderer::{MissingPipelines, PictureResources, PictureSample, PixelRect, Renderer};
use crate::scene::{Mode, Scene, Shot};

/// Limits of the work for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// True if relief is drawn for shots that request it.
    pub follows_relief: bool,
    /// Factor by which each side of the picture is reduced while something moves.
    pub moving_divisor: u32,
}

impl Quality {
    /// Returns limits that suit an adapter.
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
    prepared: PictureResources,
    /// Number of samples drawn.
    samples: u32,
    /// True if the pixels show the model as in the first sample.
    shows_first: bool,
}

/// Identification of a scene.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneRevision {
    /// Number of the scene, different for each scene.
    pub number: u64,
    /// Numbers of earlier scenes of the same model. Each has corners of boxes in view space, outside of which this scene
    /// looks the same as the earlier one.
    pub changed: Vec<(u64, Vec<[Vec3; 2]>)>,
}

/// Picture on the device that is drawn again when its inputs change, and refined sample by sample while they do not.
pub struct Viewport {
    renderer: Arc<Renderer>,
    /// Limits of the work for a picture.
    pub quality: Quality,
    target: Option<RenderTarget>,
    progress: Option<PictureProgress>,
}

impl Viewport {
    /// Creates a viewport without a picture, with the quality that suits the adapter. Several viewports may share a renderer.
    pub fn new(gpu: &Gpu, renderer: Arc<Renderer>) -> Viewport {
        Viewport {
            renderer,
            quality: Quality::of(gpu.summary().kind),
            target: None,
            progress: None,
        }
    }

    /// Returns the pipelines that have not been created yet. If they are created first, [`Viewport::show`] does not have to wait for them.
    pub fn missing(&self, scene: &Scene<'_>, shot: &Shot) -> Option<MissingPipelines> {
        self.renderer.missing(scene, &self.reduced(shot))
    }

    /// Returns the shot without features that the quality excludes.
    fn reduced(&self, shot: &Shot) -> Shot {
        Shot {
            has_relief: shot.has_relief && self.quality.follows_relief,
            ..shot.clone()
        }
    }

    /// Returns the picture; `None` before the first one.
    pub fn picture(&self) -> Option<&RenderTarget> {
        self.target.as_ref()
    }

    /// Draws the first sample of a picture if its inputs have changed, otherwise the next missing sample. While something moves, only the
    /// part of the last picture in which the scene has changed is drawn again, if that part is known. Returns true if a sample was drawn,
    /// after which more samples may be missing. Nothing is drawn for a size without area.
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
            None => RenderTarget::new(gpu, inputs.size)?,
        };
        // The progress is taken, so that after a failure no older picture seems to be current.
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
            let sample = PictureSample {
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

    /// Returns the inputs of a picture of the whole scene. While something moves, it is coarser and has a single sample.
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

    /// Draws the part of the last picture in which the scene has changed. Returns whether there was such a part; `None` if
    /// the last picture does not match, or if it is not known what has changed.
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

/// Returns the parts of the last picture in which a scene has changed; `None` if they are not known.
fn changed_parts(
    scene: &Scene<'_>,
    revision: &SceneRevision,
    before: &PictureInputs,
    shot: &Shot,
) -> Option<Vec<PixelRect>> {
    // Relief shifts the visible points, and transparent places show what is behind them.
    let is_plain = !shot.has_relief && scene.looks.iter().all(|look| look.is_opaque);
    let known = revision.changed.iter().find(|(number, _)| *number == before.revision);
    let (_, bounds) = known.filter(|_| is_plain)?;
    let parts = bounds
        .iter()
        .map(|corners| shot.camera.part_of_picture(*corners, before.size));
    parts.collect()
}

/// Returns true if two shots look the same except for their samples.
fn looks_alike(shot: &Shot, other: &Shot) -> bool {
    // The range of heights belongs to the scene. It is visible only in pictures of the height and in relief.
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
    fn only_a_software_driver_has_reduced_quality_and_a_remark_about_it() {
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
