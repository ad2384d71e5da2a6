//! A picture that is kept as long as nothing changes.

use std::sync::Arc;

use sabi_gpu::{AdapterKind, Gpu};

use crate::error::ViewError;
use crate::renderer::{Missing, Prepared, Renderer, Sample};
use crate::scene::{Scene, Shot};
use crate::target::Target;

/// Limits of the work for a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Quality {
    /// True if relief is drawn when a shot asks for it.
    pub follows_relief: bool,
    /// While something moves, each side has so many times fewer pixels.
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
struct Wanted {
    shot: Shot,
    size: [u32; 2],
    revision: u64,
}

/// The last picture, as far as it is drawn.
struct Drawn {
    wanted: Wanted,
    prepared: Prepared,
    /// Samples that are in it.
    samples: u32,
}

/// A picture on the device that is drawn again only when something changed, and refined sample by sample while nothing does.
pub struct Viewport {
    renderer: Arc<Renderer>,
    /// Limits of the work for a picture.
    pub quality: Quality,
    target: Option<Target>,
    drawn: Option<Drawn>,
}

impl Viewport {
    /// A viewport without a picture, as good as the adapter allows; several may share a renderer.
    pub fn new(gpu: &Gpu, renderer: Arc<Renderer>) -> Viewport {
        Viewport {
            renderer,
            quality: Quality::of(gpu.summary().kind),
            target: None,
            drawn: None,
        }
    }

    /// Returns the pipelines to make before [`Viewport::show`] draws this without a delay.
    pub fn missing(&self, scene: &Scene<'_>, shot: &Shot) -> Option<Missing> {
        self.renderer.missing(scene, &self.allowed(shot))
    }

    /// A shot without the features that the adapter is too slow for.
    fn allowed(&self, shot: &Shot) -> Shot {
        Shot {
            has_relief: shot.has_relief && self.quality.follows_relief,
            ..shot.clone()
        }
    }

    /// The picture; none before the first one.
    pub fn picture(&self) -> Option<&Target> {
        self.target.as_ref()
    }

    /// Draws a first sample where the last picture is not the same one, else one more where some are left: `revision` is
    /// another number whenever the scene is another one. Says whether it drew, and so whether to come again; a window without
    /// area needs no picture.
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
        let wanted = Wanted {
            shot: Shot {
                samples: if is_moving { 1 } else { shot.samples.max(1) },
                ..self.allowed(shot)
            },
            size: size.map(|side| side.div_ceil(divisor)),
            revision,
        };
        let mut target = match self.target.take().filter(|target| target.size() == wanted.size) {
            Some(target) => target,
            None => Target::new(gpu, wanted.size)?,
        };
        // A failure must not leave an older picture that looks current.
        let mut drawn = match self.drawn.take().filter(|drawn| drawn.wanted == wanted) {
            Some(drawn) => drawn,
            None => Drawn {
                prepared: self.renderer.prepare(gpu, &target, scene, &wanted.shot)?,
                samples: 0,
                wanted,
            },
        };
        let shot = &drawn.wanted.shot;
        let is_left = drawn.samples < shot.samples;
        if is_left {
            let sample = Sample {
                number: drawn.samples,
                is_shown: true,
            };
            self.renderer
                .add_sample(gpu, &mut target, scene, shot, &drawn.prepared, sample)?;
            drawn.samples += 1;
        }
        self.target = Some(target);
        self.drawn = Some(drawn);
        Ok(is_left)
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
