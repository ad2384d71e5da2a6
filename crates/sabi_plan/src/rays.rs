//! Rays of a kernel: their number, length and key.

use sabi_nodes::kind::{Argument, Kind, ParamValue, Rays};

use crate::field::working_value;
use crate::keys::result_key;
use crate::level::Level;
use crate::plan::{Reach, StepRays};
use crate::request::Planner;
use crate::resolved_graph::{Behavior, ResolvedNode};

impl Planner<'_> {
    /// Returns the rays of a node that are cast on a level, for some of its results.
    pub(crate) fn step_rays(
        &self,
        index: usize,
        ready: &ResolvedNode<'_>,
        kind: &Kind,
        rays: &Rays,
        level: Level,
        outputs: &[usize],
    ) -> StepRays {
        let ParamValue::Unsigned(count) = ready.values[rays.count] else {
            unreachable!("the number of rays of '{}' is a whole number", kind.id)
        };
        let reach = rays.reach.map(|reach| self.reach(index, ready, kind, reach));
        let is_input = |argument: &Argument| matches!(argument, Argument::Input(_));
        let is_masked = rays.reads.iter().any(|param| ready.masked_params.contains(param));
        let depends_on_inputs = is_masked || rays.arguments.iter().any(is_input);
        StepRays {
            count,
            finds: rays.finds,
            key: (!depends_on_inputs).then(|| self.rays_key(ready, kind, rays, reach, level)),
            reach,
            least_turn: rays
                .turn
                .filter(|param| !ready.masked_params.contains(param))
                .map(|param| 0.5 * working_value(ready, kind, param) as f32),
            results: outputs
                .iter()
                .map(|output| result_key(ready, &kind.outputs[*output].name))
                .collect(),
        }
    }

    /// Returns a node's values with the number of rays limited for a first preview.
    pub(crate) fn with_limited_rays(&self, behavior: Behavior<'_>, mut values: Vec<ParamValue>) -> Vec<ParamValue> {
        if let Behavior::Shader(Kind { rays: Some(rays), .. }) = behavior
            && let (Some(most), Some(ParamValue::Unsigned(count))) = (self.most_rays, values.get_mut(rays.count))
        {
            *count = (*count).min(most);
        }
        values
    }

    /// Length of the longest rays of a node.
    fn reach(&self, index: usize, ready: &ResolvedNode<'_>, kind: &Kind, reach: usize) -> Reach {
        let param = &kind.params[reach];
        let node = &self.graph.nodes[index];
        let ParamValue::Floats(value) = &ready.values[reach] else {
            unreachable!("the reach of '{}' is a length", kind.id)
        };
        let farthest = param.ty.soft.map_or(value[0], |[_, high]| value[0].max(high as f32));
        let working = f64::from(farthest) * self.working_from_length(ready.behavior, node);
        Reach {
            offset: param.offset as usize,
            longest: working as f32,
        }
    }

    /// Key of the longest rays: text of the node, parameters that rays depend on, surface and level.
    fn rays_key(
        &self,
        ready: &ResolvedNode<'_>,
        kind: &Kind,
        rays: &Rays,
        reach: Option<Reach>,
        level: Level,
    ) -> [u8; 32] {
        let mut hash = blake3::Hasher::new_derive_key("sabi rays");
        hash.update(&self.surface_key);
        self.hash_text(&mut hash, kind);
        hash.update(&[u8::from(ready.is_by_piece)]);
        hash.update(&level.bytes());
        let own = rays.reads.iter().filter(|param| rays.reach != Some(**param));
        for index in own.chain([&rays.count]) {
            let param = &kind.params[*index];
            // The default is never used: offsets lie within `struct Params`.
            let bytes = ready.params.get(param.offset as usize..).unwrap_or_default();
            let size = 4 * param.ty.memory.components();
            hash.update(&(*index as u64).to_le_bytes());
            hash.update(bytes.get(..size).unwrap_or(bytes)); // The bytes are never shorter than `size`.
        }
        if let Some(reach) = reach {
            hash.update(&reach.longest.to_le_bytes());
        }
        *hash.finalize().as_bytes()
    }
}
