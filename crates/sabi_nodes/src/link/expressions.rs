//! WGSL expressions for the arguments of calls and for stored results.

use std::collections::BTreeSet;
use std::fmt::Write;

use sabi_graph::PortType;

use super::error::{LinkError, MissingPart};
use super::sources::Callee;
use super::{
    Binding, CHANNEL_WORDS, Call, Convert, Domain, KernelSpec, KernelStore, Operand, Plane, SURVEY_GROUPS,
    StoredLayout, channel_bits,
};
use crate::kind::{Argument, Channel, InputDefault, Kind, Shape};

/// Returns the name of a plane in generated code.
pub(super) fn plane_name(plane: Plane) -> &'static str {
    match plane {
        Plane::Mask => "mask",
        Plane::Color => "rgb",
        Plane::Vector => "xyz",
        Plane::Material(Channel::Color) => "color",
        Plane::Material(Channel::Surface) => "surface",
        Plane::Material(Channel::Height) => "height",
        Plane::Material(Channel::Slope) => "slope",
        Plane::Material(Channel::Emission) => "emission",
        Plane::Material(Channel::Coat) => "coat",
        Plane::Material(Channel::Anisotropy) => "anisotropy",
        Plane::Material(Channel::Sheen) => "sheen",
        Plane::Material(Channel::Subsurface) => "subsurface",
    }
}

/// Returns the name of the variable that holds the mean of a pass over rays.
pub(super) fn mean_name(pass: usize) -> String {
    format!("mean_{pass}")
}

/// Names of the local variables declared so far in the body of an entry point.
pub(super) type Locals = BTreeSet<String>;

/// The call whose arguments are being written.
pub(super) struct Caller<'a> {
    /// Number of the call.
    pub(super) index: usize,
    pub(super) call: &'a Call,
    pub(super) callee: Callee<'a>,
    pub(super) spec: &'a KernelSpec,
}

impl Caller<'_> {
    /// Writes the variables that the arguments of a function need, and returns the arguments as text.
    pub(super) fn arguments(
        &self,
        out: &mut String,
        locals: &mut Locals,
        arguments: &[Argument],
    ) -> Result<String, LinkError> {
        let mut written = Vec::new();
        for argument in arguments {
            written.push(match argument {
                Argument::At => "at".to_owned(),
                Argument::Params => format!("bounded_{}", self.call.block),
                Argument::Index => "index".to_owned(),
                Argument::Ray => "ray".to_owned(),
                Argument::Hit => "hit".to_owned(),
                Argument::Round => "Round(dispatch.round, dispatch.rounds, dispatch.texel, dispatch.finest)".to_owned(),
                Argument::Survey => self.texture(self.call.survey.ok_or_else(|| self.lacks(MissingPart::Survey))?)?,
                Argument::Group => "u32(texel.x)".to_owned(),
                Argument::Shared(shared) => self.write_shared(out, locals, *shared)?,
                Argument::Pass(pass) if self.spec.domain == Domain::OwnedTexelsByRays => mean_name(*pass),
                Argument::Pass(pass) if self.kind().shape == Shape::Ray => self.write_mean(out, locals, *pass)?,
                Argument::Pass(pass) => self.pass(*pass)?,
                Argument::Input(input) => match self.call.inputs.get(*input) {
                    Some(Binding::Switch(load)) => self.write_switch(out, locals, *input, *load)?,
                    Some(binding) => self.input(*input, *binding)?,
                    None => return Err(self.lacks_input(*input)),
                },
            });
        }
        Ok(written.join(", "))
    }

    /// Writes a local variable that holds the result of a shared function, once for all calls of the node. Returns its name.
    fn write_shared(&self, out: &mut String, locals: &mut Locals, index: usize) -> Result<String, LinkError> {
        let Some(shared) = self.kind().shared.get(index) else {
            return Err(LinkError::UnknownFunction(self.kind().id.clone(), index.to_string()));
        };
        let arguments = self.arguments(out, locals, &shared.arguments)?;
        let name = format!("shared_{}_{index}", self.call.block);
        if locals.insert(name.clone()) {
            let prefix = self.callee.prefix();
            let _ = writeln!(out, "    let {name} = {prefix}{}({arguments});", shared.name);
        }
        Ok(name)
    }

    /// Returns the length that limits the rays of a node; unlimited if no parameter limits them.
    fn reach_of_rays(&self) -> String {
        let kind = self.kind();
        let reach = kind.rays.as_ref().and_then(|rays| rays.reach);
        reach.and_then(|reach| kind.params.get(reach)).map_or_else(
            || "1e30".to_owned(),
            |param| format!("bounded_{}.{}", self.call.block, param.name),
        )
    }

    /// Writes a local variable that holds the stored mean of a pass over rays, once for all calls of the node. Returns its name.
    fn write_mean(&self, out: &mut String, locals: &mut Locals, pass: usize) -> Result<String, LinkError> {
        let texture = self.pass(pass)?;
        let is_number = self.kind().passes[pass].function.ty == PortType::Mask;
        let mean = match self.kind().passes[pass].denoise {
            Some(denoise) => {
                let normals = self.call.normals.ok_or_else(|| self.lacks(MissingPart::Normals))?;
                let (normals, normal) = (self.texture(normals)?, denoise.normal());
                format!("denoised({texture}, {normals}, at, {normal}, {})", self.reach_of_rays())
            }
            None => format!("textureLoad({texture}, texel.xy, texel.z, 0).xyz"),
        };
        let name = mean_name(pass);
        if locals.insert(name.clone()) {
            let _ = writeln!(out, "    let {name} = {mean}{};", if is_number { ".x" } else { "" });
        }
        Ok(name)
    }

    fn kind(&self) -> &Kind {
        self.callee.kind
    }

    /// Returns the expressions of the masks that multiply parameters, by index of the parameter.
    pub(super) fn param_masks(&self) -> Result<Vec<(usize, String)>, LinkError> {
        let masks = self.call.param_masks.iter();
        masks.map(|(param, mask)| Ok((*param, self.value(*mask)?))).collect()
    }

    fn lacks(&self, missing: MissingPart) -> LinkError {
        LinkError::Incomplete {
            reader: format!("`{}` of the node kind '{}'", self.call.function, self.kind().id),
            missing,
        }
    }

    fn lacks_input(&self, input: usize) -> LinkError {
        self.lacks(match self.kind().inputs.get(input) {
            Some(input) => MissingPart::Input(input.name.clone()),
            None => MissingPart::Input(input.to_string()),
        })
    }

    fn load(&self, load: usize) -> Result<&StoredLayout, LinkError> {
        self.spec
            .loads
            .get(load)
            .ok_or_else(|| self.lacks(MissingPart::Load(load)))
    }

    fn texture(&self, load: usize) -> Result<String, LinkError> {
        let planes = self.load(load)?.planes();
        let plane = planes.first().ok_or_else(|| self.lacks(MissingPart::Load(load)))?;
        Ok(format!("load_{load}_{}", plane_name(*plane)))
    }

    /// Returns the stored result of a pass: a texture, or for a survey the value for the whole surface or for the group.
    fn pass(&self, pass: usize) -> Result<String, LinkError> {
        let Some(load) = self.call.passes.get(pass).copied().flatten() else {
            let name = self.kind().passes.get(pass).map(|pass| pass.function.name.clone());
            return Err(self.lacks(MissingPart::Pass(name.unwrap_or_else(|| pass.to_string()))));
        };
        let texture = self.texture(load)?;
        let group = self.group();
        Ok(match (self.kind().shape, self.load(load)?.ty) {
            (Shape::Survey, PortType::Mask) => format!("textureLoad({texture}, {group}, 0, 0).x"),
            (Shape::Survey, _) => format!("textureLoad({texture}, {group}, 0, 0).xyz"),
            _ => texture,
        })
    }

    /// Returns the texel that holds the values of the survey for the group of a place.
    fn group(&self) -> String {
        let Some(param) = self
            .kind()
            .survey_groups
            .and_then(|index| self.kind().params.get(index))
        else {
            return "vec2i(0)".to_owned();
        };
        let each = format!("bounded_{}.{}", self.call.block, param.name);
        let number = format!(
            "select(select(select(0u, at.part, {each} == 1u), at.piece, {each} == 2u), at.chart, {each} == 3u)"
        );
        format!("vec2i(i32({number} % {SURVEY_GROUPS}u), 0)")
    }

    fn input(&self, input: usize, binding: Binding) -> Result<String, LinkError> {
        match binding {
            Binding::Default | Binding::Switch(_) => self.default_of(input),
            Binding::Value(operand) => self.value(operand),
            Binding::Field(load) => self.texture(load),
        }
    }

    fn value(&self, operand: Operand) -> Result<String, LinkError> {
        match operand {
            Operand::Call(from, convert) => Ok(converted(&format!("v{from}"), convert)),
            Operand::Load(load, convert) => Ok(converted(&load_expression(load, self.load(load)?), convert)),
            Operand::Normal(denoise) => Ok(denoise.normal().to_owned()),
        }
    }

    /// Returns the value of an input to which nothing is connected.
    fn default_of(&self, input: usize) -> Result<String, LinkError> {
        let Some(port) = self.kind().inputs.get(input) else {
            return Err(self.lacks_input(input));
        };
        Ok(match &port.default {
            InputDefault::Knob(_) => format!("block.knobs_{}.{}", self.call.block, port.name),
            InputDefault::Expression(expression) => expression.clone(),
            InputDefault::PlainMaterial => "plain_material()".to_owned(),
            InputDefault::Required => return Err(self.lacks_input(input)),
        })
    }

    /// Writes a local variable whose value depends on the flags of the block at run time, once for all calls of the node.
    /// Returns its name.
    ///
    /// Flag word 0 has two bits for each input: 0 default, 1 unchanged, 2 gray to color, 3 luminance. The other words have
    /// a bit for each channel of each material input, see [`channel_bits`].
    fn write_switch(
        &self,
        out: &mut String,
        locals: &mut Locals,
        input: usize,
        load: usize,
    ) -> Result<String, LinkError> {
        let name = format!("in_{}_{input}", self.call.block);
        if !locals.insert(name.clone()) {
            return Ok(name);
        }
        let default = self.default_of(input)?;
        let mode = format!("((block.flags.x >> {}u) & 3u)", 2 * input);
        let _ = writeln!(out, "    var {name} = {default};");
        let stored = self.load(load)?;
        let value = match stored.ty {
            PortType::Material => {
                let before = self.kind().inputs.iter().take(input);
                let before = before.filter(|port| port.ty == PortType::Material).count();
                let (word, shift) = channel_bits(before);
                let word = CHANNEL_WORDS.get(word - 1).ok_or_else(|| self.lacks_input(input))?;
                material_of_planes(load, &format!("block.flags.{word} >> {shift}u"), &stored.channels)
            }
            PortType::Mask => format!("switched_mask({mode}, {})", texel_expression(load, Plane::Mask)),
            PortType::Color => format!("switched_color({mode}, {})", texel_expression(load, Plane::Color)),
            PortType::Vector => format!("{}.xyz", texel_expression(load, Plane::Vector)),
        };
        let _ = writeln!(out, "    if {mode} != 0u {{ {name} = {value}; }}");
        Ok(name)
    }
}

fn converted(value: &str, convert: Convert) -> String {
    match convert {
        Convert::None => value.to_owned(),
        Convert::Gray => format!("vec3f({value})"),
        Convert::Luminance => format!("luminance({value})"),
    }
}

fn texel_expression(load: usize, plane: Plane) -> String {
    format!("textureLoad(load_{load}_{}, texel.xy, texel.z, 0)", plane_name(plane))
}

fn load_expression(load: usize, stored: &StoredLayout) -> String {
    match stored.ty {
        PortType::Mask => format!("{}.x", texel_expression(load, Plane::Mask)),
        PortType::Color => format!("{}.xyz", texel_expression(load, Plane::Color)),
        PortType::Vector => format!("{}.xyz", texel_expression(load, Plane::Vector)),
        PortType::Material => material_expression(load, &stored.channels),
    }
}

/// Returns the expression of a stored material. Channels that are not stored are those of the plain material.
fn material_expression(load: usize, channels: &[Channel]) -> String {
    let present = channels.iter().fold(0, |bits, channel| bits | 1_u32 << *channel as u32);
    material_of_planes(load, &format!("{present}u"), channels)
}

/// Returns the expression of a material made from the bound planes. `present` tells at run time which planes hold values.
fn material_of_planes(load: usize, present: &str, bound: &[Channel]) -> String {
    let plane = |channel: &Channel| match bound.contains(channel) {
        true => texel_expression(load, Plane::Material(*channel)),
        false => "vec4f(0.0)".to_owned(),
    };
    let [color, surface, height, slope, emission, rare @ ..] = Channel::ALL.each_ref().map(plane);
    let common = format!("switched_material({present}, {color}, {surface}, {height}.x, {slope}.xyz, {emission}.xyz)");
    if bound.iter().all(|channel| Channel::COMMON.contains(channel)) {
        return common;
    }
    format!("with_rare_channels({common}, {present}, {})", rare.join(", "))
}

/// Writes one result to its textures.
pub(super) fn write_store(
    out: &mut String,
    index: usize,
    store: &KernelStore,
    spec: &KernelSpec,
) -> Result<(), LinkError> {
    let value = match store.value {
        Operand::Call(call, convert) => converted(&format!("v{call}"), convert),
        Operand::Load(load, convert) => {
            let stored = spec.loads.get(load).ok_or_else(|| LinkError::Incomplete {
                reader: format!("the result {index} of a kernel"),
                missing: MissingPart::Load(load),
            })?;
            converted(&load_expression(load, stored), convert)
        }
        Operand::Normal(denoise) => denoise.normal().to_owned(),
    };
    // Kernels of points may write a band of the atlas.
    let place = match spec.domain {
        Domain::AllTexels => "written",
        Domain::Once | Domain::Groups | Domain::OwnedTexels | Domain::OwnedTexelsByRays => "texel",
    };
    let _ = writeln!(out, "    let s{index} = {value};");
    for plane in store.stored.planes() {
        let value = match plane {
            Plane::Mask => format!("vec4f(s{index}, 0.0, 0.0, 1.0)"),
            Plane::Color | Plane::Vector => format!("vec4f(s{index}, 1.0)"),
            Plane::Material(Channel::Color) => format!("vec4f(s{index}.base_color, s{index}.alpha)"),
            Plane::Material(Channel::Surface) => {
                format!("vec4f(s{index}.roughness, s{index}.metallic, s{index}.occlusion, 1.0)")
            }
            Plane::Material(Channel::Height) => format!("vec4f(s{index}.height, 0.0, 0.0, 1.0)"),
            Plane::Material(Channel::Slope) => format!("vec4f(s{index}.slope, 1.0)"),
            Plane::Material(Channel::Emission) => format!("vec4f(s{index}.emission, 1.0)"),
            Plane::Material(Channel::Coat) => format!("vec4f(s{index}.coat, s{index}.coat_roughness, 0.0, 1.0)"),
            Plane::Material(Channel::Anisotropy) => format!("vec4f(s{index}.anisotropy, 1.0)"),
            Plane::Material(Channel::Sheen) => format!("vec4f(s{index}.sheen, s{index}.sheen_roughness)"),
            Plane::Material(Channel::Subsurface) => format!("vec4f(s{index}.subsurface, s{index}.transmission)"),
        };
        let name = plane_name(plane);
        let _ = writeln!(
            out,
            "    textureStore(store_{index}_{name}, {place}.xy, {place}.z, {value});"
        );
    }
    Ok(())
}
