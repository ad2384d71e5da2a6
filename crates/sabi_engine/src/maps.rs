//! Results become maps: read back, brought into the model's own layout, and written.

use rayon::prelude::*;
use sabi_export::{
    AtlasTexels, BakeWriter, Channel, ConstantRecord, OutputRecord, Padding, PaddingMap, SetLayout, SetOptions,
};
use sabi_gpu::{PlaneData, Run, RunOptions};
use sabi_graph::PortType;
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{Plan, PlannedResult, SlotRef};

use crate::error::EngineError;
use crate::stages::{Progress, Stage};
use crate::workpiece::{Workpiece, stop_if_canceled};

/// One texture set: which results go into it.
pub(crate) struct SetWork<'p> {
    /// Where its pixels come from.
    pub(crate) layout: SetLayout,
    /// Stem of its files.
    pub(crate) name: String,
    /// The material, if an output serves it.
    pub(crate) material: Option<&'p PlannedResult>,
    /// More maps by name.
    pub(crate) masks: Vec<(String, &'p PlannedResult)>,
}

/// What was written.
#[derive(Default)]
pub(crate) struct WrittenMaps {
    pub(crate) outputs: Vec<OutputRecord>,
    pub(crate) constants: Vec<ConstantRecord>,
    pub(crate) warnings: Vec<String>,
    /// Kernels that only exports need.
    pub(crate) finish_passes: usize,
}

/// Writes the maps of texture sets, one set and one plane at a time.
pub(crate) struct MapWriter<'a> {
    pub(crate) workpiece: &'a Workpiece,
    pub(crate) plan: &'a Plan,
    pub(crate) options: SetOptions,
    pub(crate) padding: Padding,
    pub(crate) run_options: RunOptions<'a>,
}

/// Texels as floats, with the number of values a texel.
struct Texels {
    data: Vec<f32>,
    stride: usize,
}

impl Texels {
    fn new(plane: &PlaneData, stride: usize, scale: f32) -> Texels {
        let mut data = vec![0.0_f32; plane.len() * stride];
        data.par_chunks_mut(stride)
            .enumerate()
            .with_min_len(4096)
            .for_each(|(index, values)| {
                for (value, stored) in values.iter_mut().zip(plane.texel(index)) {
                    *value = stored * scale;
                }
            });
        Texels { data, stride }
    }
}

impl MapWriter<'_> {
    /// Writes all sets under temporary names.
    pub(crate) fn write(
        &self,
        run: &mut Run,
        sets: &[SetWork<'_>],
        writer: &mut BakeWriter,
        progress: &dyn Progress,
    ) -> Result<WrittenMaps, EngineError> {
        let mut written = WrittenMaps::default();
        for (done, set) in sets.iter().enumerate() {
            progress.advance(Stage::Encode, done, sets.len());
            let padding = PaddingMap::new(&set.layout, self.padding);
            let mut maps = SetMaps {
                from: self,
                set,
                padding,
                writer: &mut *writer,
                written: &mut written,
            };
            if let Some(result) = set.material {
                maps.material(run, result, progress)?;
            }
            for (name, result) in &set.masks {
                stop_if_canceled(progress)?;
                maps.mask(run, name, result)?;
            }
        }
        progress.advance(Stage::Encode, sets.len(), sets.len());
        Ok(written)
    }

    fn read(&self, run: &Run, slot: SlotRef) -> Result<PlaneData, EngineError> {
        Ok(self.workpiece.gpu.read(&self.workpiece.surface, self.plan, run, slot)?)
    }
}

/// One texture set on its way to disk.
struct SetMaps<'a> {
    from: &'a MapWriter<'a>,
    set: &'a SetWork<'a>,
    padding: PaddingMap,
    writer: &'a mut BakeWriter,
    written: &'a mut WrittenMaps,
}

/// Stored channels, and for each the exported ones with the first of their values in a texel.
const MAPS: [(Stored, &[(Channel, usize)]); 4] = [
    (Stored::Color, &[(Channel::BaseColor, 0), (Channel::Opacity, 3)]),
    (
        Stored::Surface,
        &[(Channel::Roughness, 0), (Channel::Metallic, 1), (Channel::Occlusion, 2)],
    ),
    (Stored::Height, &[(Channel::Height, 0)]),
    (Stored::Emission, &[(Channel::Emission, 0)]),
];

impl SetMaps<'_> {
    fn material(&mut self, run: &mut Run, result: &PlannedResult, progress: &dyn Progress) -> Result<(), EngineError> {
        let workpiece = self.from.workpiece;
        let slot = |channel| slot_of(result, Plane::Material(channel));
        let model_from_working = (1.0 / workpiece.prepared.working_from_model(&workpiece.fit)) as f32;
        for (stored, channels) in MAPS {
            stop_if_canceled(progress)?;
            let scale = if stored == Stored::Height {
                model_from_working
            } else {
                1.0
            };
            let stride = channels
                .iter()
                .map(|(channel, first)| first + channel.components())
                .max()
                .unwrap_or(1);
            let texels = match slot(stored) {
                Some(slot) => Some(Texels::new(&self.from.read(run, slot)?, stride, scale)),
                None => None,
            };
            for (channel, first) in channels {
                self.channel(channel, texels.as_ref(), *first)?;
            }
        }
        let (height, slope) = (slot(Stored::Height), slot(Stored::Slope));
        let normals = if height.is_some() || slope.is_some() {
            self.written.finish_passes += 1;
            let plane = workpiece
                .gpu
                .normals(&workpiece.surface, run, height, slope, &self.from.run_options)?;
            Some(Texels::new(&plane, 3, 1.0))
        } else {
            None
        };
        self.channel(&Channel::Normal, normals.as_ref(), 0)
    }

    fn mask(&mut self, run: &Run, name: &str, result: &PlannedResult) -> Result<(), EngineError> {
        let texels = match result.slots.first() {
            Some(slot) => Some(gray(&self.from.read(run, *slot)?, result.stored.ty == PortType::Color)),
            None => None,
        };
        self.channel(&Channel::Mask(name.to_owned()), texels.as_ref(), 0)
    }

    /// Writes one channel; without texels, what the channel is where nothing sets it.
    fn channel(&mut self, channel: &Channel, texels: Option<&Texels>, first: usize) -> Result<(), EngineError> {
        let none = Texels {
            data: Vec::new(),
            stride: channel.components(),
        };
        let texels = texels.unwrap_or(&none);
        let from = AtlasTexels {
            data: &texels.data,
            stride: texels.stride,
            first,
        };
        let pixels = self.padding.gather(&self.set.layout, channel, from);
        let mut set = self.writer.set(&self.set.layout, &self.set.name, &self.from.options);
        let done = set.channel(channel, pixels)?;
        if done.not_finite > 0 {
            self.written.warnings.push(format!(
                "{} values of {} in '{}' were no numbers and were replaced; look for a division by zero in the graph",
                done.not_finite,
                channel.name(),
                self.set.name
            ));
        }
        self.written.outputs.extend(done.outputs);
        self.written.constants.extend(done.constant);
        Ok(())
    }
}

/// The slot of a plane of a result.
pub(crate) fn slot_of(result: &PlannedResult, plane: Plane) -> Option<SlotRef> {
    let at = result.stored.planes().iter().position(|stored| *stored == plane)?;
    result.slots.get(at).copied()
}

/// A mask as it is, or the luminance of a color (Rec. 709), as `lib/core.wgsl` has it.
fn gray(plane: &PlaneData, is_color: bool) -> Texels {
    let data = (0..plane.len()).into_par_iter().with_min_len(4096).map(|index| {
        let [r, g, b, _] = plane.texel(index);
        if is_color {
            0.2126 * r + 0.7152 * g + 0.0722 * b
        } else {
            r
        }
    });
    Texels {
        data: data.collect(),
        stride: 1,
    }
}
