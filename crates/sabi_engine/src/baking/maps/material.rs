//! Maps of a material: its stored planes, and maps computed from them.

use sabi_export::Channel;
use sabi_gpu::{Normals, PlaneData, Run, read_anisotropy};
use sabi_nodes::kind::Channel as Stored;
use sabi_nodes::link::Plane;
use sabi_plan::{PlannedResult, SlotRef};

use super::sameness::Sameness;
use super::{MapStep, Maps, OpenSet};
use crate::error::EngineError;
use crate::evaluating::looks::slot_of;

/// Stored channels, each with its exported channels and the index of their first value in a texel. The plane of the small
/// maps comes before the colors, so that its texture is free when the pixels of a color map take the most memory.
pub(super) const MAPS: [(Stored, &[(Channel, usize)]); 7] = [
    (
        Stored::Surface,
        &[(Channel::Roughness, 0), (Channel::Metallic, 1), (Channel::Occlusion, 2)],
    ),
    (Stored::Color, &[(Channel::BaseColor, 0), (Channel::Opacity, 3)]),
    (Stored::Height, &[(Channel::Height, 0)]),
    (Stored::Emission, &[(Channel::Emission, 0)]),
    (Stored::Coat, &[(Channel::Coat, 0), (Channel::CoatRoughness, 1)]),
    (Stored::Sheen, &[(Channel::Sheen, 0), (Channel::SheenRoughness, 3)]),
    (
        Stored::Subsurface,
        &[(Channel::Subsurface, 0), (Channel::Transmission, 3)],
    ),
];

impl<'s> Maps<'_, 's> {
    /// Writes the maps of a material for all sets that use the same results.
    pub(super) fn material(
        &mut self,
        run: &mut Run,
        results: &[&PlannedResult],
        sets: &[&'s OpenSet<'s>],
    ) -> Result<(), EngineError> {
        if sets.is_empty() {
            return Ok(());
        }
        let evaluator = self.from.evaluator;
        let file_from_working = evaluator.model().file_from_working() as f32;
        for (stored, channels) in MAPS {
            let scale = if stored == Stored::Height {
                file_from_working
            } else {
                1.0
            };
            let value = |[x, y, z, w]: [f32; 4]| [x * scale, y * scale, z * scale, w * scale];
            self.stored(run, results, sets, stored, channels, value)?;
        }
        self.normal_maps(run, results, sets)?;
        let mut anisotropies = Vec::new();
        for result in results {
            anisotropies.push(self.anisotropy(run, result)?);
        }
        for set in sets {
            self.channel(set, &Channel::Anisotropy, &anisotropies, 0, |[x, y, strength, _]| {
                [x * 0.5 + 0.5, y * 0.5 + 0.5, strength, 1.0]
            })?;
            self.steps.send(MapStep::Advance)?;
        }
        Ok(())
    }

    /// Writes the maps of a stored plane.
    fn stored(
        &mut self,
        run: &mut Run,
        results: &[&PlannedResult],
        sets: &[&'s OpenSet<'s>],
        stored: Stored,
        channels: &[(Channel, usize)],
        value: impl Fn([f32; 4]) -> [f32; 4] + Copy + Sync,
    ) -> Result<(), EngineError> {
        let slots: Vec<Option<SlotRef>> = results
            .iter()
            .map(|result| slot_of(result, Plane::Material(stored)))
            .collect();
        if let [slot] = slots[..]
            && sets.iter().all(|set| set.is_gathered_in_bands())
        {
            for set in sets {
                let seen = Sameness::default();
                for (at, (channel, first)) in channels.iter().enumerate() {
                    match seen.of(*first, channel.components()) {
                        Some(texel) => self.even_channel(set, channel, *first, value(texel))?,
                        None => {
                            let is_last = at + 1 == channels.len();
                            let noted = |texel| value(if is_last { texel } else { seen.noted(texel) });
                            self.channel_in_bands(run, slot, set, channel, *first, noted)?;
                        }
                    }
                }
                self.steps.send(MapStep::Advance)?;
            }
        } else {
            let planes = slots
                .iter()
                .map(|slot| slot.map(|slot| self.from.read(run, slot)).transpose())
                .collect::<Result<Vec<_>, EngineError>>()?;
            for set in sets {
                for (channel, first) in channels {
                    self.channel(set, channel, &planes, *first, value)?;
                }
                self.steps.send(MapStep::Advance)?;
            }
        }
        if stored != Stored::Height {
            self.free(run, &slots);
        }
        Ok(())
    }

    /// Computes and writes the normal maps. After that, heights and slopes are no longer needed.
    fn normal_maps(
        &mut self,
        run: &mut Run,
        results: &[&PlannedResult],
        sets: &[&'s OpenSet<'s>],
    ) -> Result<(), EngineError> {
        match (results, sets) {
            ([result], [set]) if set.is_gathered_in_bands() => self.normals_in_bands(run, result, set)?,
            _ => {
                let mut normals = Vec::new();
                for result in results {
                    normals.push(self.normals(run, result)?);
                }
                for set in sets {
                    self.channel(set, &Channel::Normal, &normals, 0, |normal| normal)?;
                    self.steps.send(MapStep::Advance)?;
                }
            }
        }
        for result in results {
            self.free(
                run,
                &[Stored::Height, Stored::Slope].map(|stored| slot_of(result, Plane::Material(stored))),
            );
        }
        Ok(())
    }

    /// Frees the textures of planes, unless other sets or results still need them.
    pub(super) fn free(&self, run: &mut Run, slots: &[Option<SlotRef>]) {
        let plan = self.from.plan;
        let uses = |slot: SlotRef| {
            plan.results
                .iter()
                .flat_map(|result| &result.slots)
                .filter(|of| **of == slot)
                .count()
        };
        for slot in slots.iter().flatten().filter(|_| self.frees_results) {
            if uses(*slot) == 1 {
                run.free(plan, *slot);
            }
        }
    }

    /// Computes the anisotropy of a result in the tangent frame; `None` if it has none.
    fn anisotropy(&mut self, run: &mut Run, result: &PlannedResult) -> Result<Option<PlaneData>, EngineError> {
        let Some(slot) = slot_of(result, Plane::Material(Stored::Anisotropy)) else {
            return Ok(None);
        };
        self.finish_passes += 1;
        let evaluator = self.from.evaluator;
        let (gpu, surface) = (evaluator.gpu(), evaluator.surface());
        Ok(Some(read_anisotropy(gpu, surface, run, slot, &self.from.run_options)?))
    }

    /// Computes the normals of a result; `None` if it has neither height nor slope.
    fn normals(&mut self, run: &mut Run, result: &PlannedResult) -> Result<Option<PlaneData>, EngineError> {
        let slot = |channel| slot_of(result, Plane::Material(channel));
        let (height, slope) = (slot(Stored::Height), slot(Stored::Slope));
        if height.is_none() && slope.is_none() {
            return Ok(None);
        }
        self.finish_passes += 1;
        let evaluator = self.from.evaluator;
        let normals = Normals {
            gpu: evaluator.gpu(),
            surface: evaluator.surface(),
            height,
            slope,
            options: &self.from.run_options,
        };
        Ok(Some(normals.read(run)?))
    }
}
