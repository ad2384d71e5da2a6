//! Channels that a function that returns a material can set, and the conditions under which it does.
//!
//! The analysis traces each member of the returned material back to its origin. A member that is only copied, mixed or selected from
//! material inputs is passed on, which does not count as set. Code that the analysis cannot follow counts as always set.

mod frame;
mod members;
mod needs;
mod tracer;
mod writes;

use naga::{Function, Handle, Module, Type, TypeInner};

use self::members::Members;
use self::needs::Needs;
use self::tracer::{TraceFuel, Tracer};
use self::writes::{channel_write, without_stronger};
use crate::kind::{Argument, Channel, ChannelWrite, Param};
use crate::params::params_type;

/// Maximum length of a path through expressions.
const DEPTH_LIMIT: u32 = 64;

/// Returns the channels that the material function `root` sets; none for functions with other results.
pub(super) fn channels(
    module: &Module,
    params: &[Param],
    root: Handle<Function>,
    inputs: &[Argument],
) -> Vec<ChannelWrite> {
    let Some((
        material,
        Type {
            inner: TypeInner::Struct { members, .. },
            ..
        },
    )) = module
        .types
        .iter()
        .find(|(_, ty)| ty.name.as_deref() == Some("Material"))
    else {
        return Vec::new();
    };
    if module.functions[root].result.as_ref().map(|result| result.ty) != Some(material) {
        return Vec::new();
    }
    let plain = module
        .functions
        .iter()
        .find(|(_, function)| function.name.as_deref() == Some("plain_material"));
    let mut tracer = Tracer {
        needs: Needs {
            module,
            params,
            params_type: params_type(module).map(|(handle, _)| handle),
            root,
            inputs,
        },
        members: Members::of(members),
        material,
        plain: plain.map(|(handle, _)| handle),
        fuel: TraceFuel::new(),
    };
    let arguments = vec![vec![None; members.len()]; module.functions[root].arguments.len()];
    let writes = tracer.function(root, arguments, DEPTH_LIMIT);
    let of_channel = |channel| {
        let members = writes.iter().zip(tracer.members.channels());
        let of_channel = members.filter(move |(_, of)| **of == Some(channel));
        let written: Vec<_> = of_channel.filter_map(|(write, _)| write.clone()).collect();
        without_stronger(&written)
            .map(move |needs| channel_write(channel, needs))
            .collect::<Vec<_>>()
    };
    Channel::ALL.into_iter().flat_map(of_channel).collect()
}
