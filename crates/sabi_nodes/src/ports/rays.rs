//! Reads the function `ray`.

use naga::Type;

use super::{FunctionDraft, PortReader, Ports, is_u32};
use crate::kind::{Argument, Output, Rays, Reads};
use crate::scan::Member;

impl<'a> PortReader<'a> {
    /// Reads the function that returns a `Ray`.
    pub(super) fn rays(&mut self, draft: &FunctionDraft<'a>) -> Option<Rays> {
        let name = draft.item.name.as_str();
        let range = draft.item.name_range.clone();
        if name != "ray" {
            let message = format!("`{name}` returns a ray, and the function that does so is called `ray`.");
            self.at(range, message, "Call it `ray`, or remove its `///` comment.");
            return None;
        }
        let arguments = self.arguments(draft);
        if arguments
            .iter()
            .any(|argument| argument.is_of_ray() || matches!(argument, Argument::Pass(_)))
        {
            let advice = "Let it take `at: Surface`, `index: u32`, `params: Params` and inputs that are values.";
            self.at(range.clone(), "`ray` is asked before anything is hit.", advice);
        }
        let Some((count, _)) = draft.annotations.rays else {
            if !self.faults.is_empty() {
                return None;
            }
            let advice = "Write `/// @rays params.rays` above it, with a `u32` parameter that has a `@range`.";
            self.at(range, "`ray` does not say how many rays there are.", advice);
            return None;
        };
        Some(Rays {
            arguments,
            count,
            finds: draft.annotations.finds,
            reach: draft.annotations.reach.as_ref().map(|(reach, _)| *reach),
            turn: draft.annotations.turn.as_ref().map(|(turn, _)| *turn),
            texel: draft.annotations.texel.as_ref().map(|(texel, _)| texel.clone()),
            // Set later, by the analysis of the functions.
            reads: Vec::new(),
        })
    }

    /// Reads `index: u32`.
    pub(super) fn ray_index(&mut self, member: &Member, ty: &Type) -> Option<Argument> {
        if is_u32(ty) {
            return Some(Argument::Index);
        }
        let range = member.type_range.clone();
        self.at(range, "The number of a ray is a `u32`.", "Write `index: u32`.");
        None
    }

    /// Reads an argument that receives the mean of a pass over rays, or its value for the whole surface.
    pub(super) fn mean_argument(&mut self, member: &Member, is_its_type: bool, pass: usize) -> Option<Argument> {
        if is_its_type {
            return Some(Argument::Pass(pass));
        }
        let what = if self.has_rays {
            "the mean of a pass over the rays"
        } else {
            "what a pass gives for the whole surface"
        };
        let message = format!("`{}` is {what}, and has its type.", member.name);
        let advice = "Give the argument the type that the pass returns.";
        self.at(member.type_range.clone(), message, advice);
        None
    }

    /// Checks that all results of a node that shoots rays depend on rays or on means of passes, and that the node reads no textures.
    pub(super) fn check_rays(&mut self, drafts: &[FunctionDraft<'a>], ports: &Ports) {
        if !self.faults.is_empty() {
            return;
        }
        let place = |name: &str| drafts.iter().find(|draft| draft.item.name == name);
        let passes = ports.passes.iter().map(|pass| (&pass.function, true));
        for (output, is_pass) in ports.outputs.iter().map(|output| (output, false)).chain(passes) {
            let range = place(&output.name).map_or(0..0, |draft| draft.item.name_range.clone());
            if let Some((message, advice)) = self.misused_rays(output, is_pass) {
                self.at(range, message, advice);
            }
        }
        self.check_denoised(drafts, ports);
        let textures = self.inputs.iter().any(|input| input.reads == Reads::Field);
        if let Some(draft) = drafts.iter().find(|draft| draft.is_ray())
            && textures
        {
            let advice = "Let its inputs be values, and filter its result with a node behind it.";
            let range = draft.item.name_range.clone();
            self.at(range, "A node that makes rays reads no textures.", advice);
        }
    }

    /// Checks that only means over rays are denoised, and all by the same method.
    fn check_denoised(&mut self, drafts: &[FunctionDraft<'a>], ports: &Ports) {
        let mut first = None;
        for draft in drafts {
            let Some((denoise, range)) = &draft.annotations.denoise else {
                continue;
            };
            let name = &draft.item.name;
            let pass = ports.passes.iter().find(|pass| pass.function.name == *name);
            if !pass.is_some_and(|pass| pass.function.arguments.iter().any(Argument::is_of_ray)) {
                let message = format!("`{name}` is no mean over rays, and has no grain.");
                let advice = "Write `@denoise` above a pass that takes `ray: Ray` or `hit: Hit`.";
                self.at(range.clone(), message, advice);
            } else if *first.get_or_insert(*denoise) != *denoise {
                let message = format!("`{name}` is denoised in another way than the passes before it.");
                self.at(range.clone(), message, "Write the same word behind each `@denoise`.");
            }
        }
    }

    /// Returns message and advice for a function whose arguments about rays are wrong.
    fn misused_rays(&self, output: &Output, is_pass: bool) -> Option<(String, &'static str)> {
        let name = &output.name;
        let rays = output.arguments.iter().any(Argument::is_of_ray);
        let means = output
            .arguments
            .iter()
            .any(|argument| matches!(argument, Argument::Pass(_)));
        if !self.has_rays {
            let message = format!("`{name}` reads what a ray hit, but no function makes rays.");
            let advice = "Add `fn ray(at: Surface, index: u32, params: Params) -> Ray` with a `///` comment.";
            return rays.then_some((message, advice));
        }
        if is_pass && means {
            let message = format!("The pass `{name}` reads no ray.");
            return Some((message, "Passes are means over rays; let the outputs do the rest."));
        }
        match (rays, means) {
            (false, false) => Some((
                format!("`{name}` reads no ray."),
                "Let it take `ray: Ray` or `hit: Hit`, or the result of a pass that does.",
            )),
            (true, true) => Some((
                format!("`{name}` reads single rays and means over rays at once."),
                "Let a pass read the rays, and the output the means of passes.",
            )),
            _ => None,
        }
    }
}
