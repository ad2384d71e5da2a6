//! WGSL declarations that are repeated in Rust: uploaded structs, constants and workgroup sizes. A test compares each with
//! all shader modules that contain it.

use std::fmt::Debug;

use super::reflect::{Reflection, StructLayout};

/// Prefix of the names of padding members.
const PADDING: &str = "pad";

/// A struct, constant or workgroup size that is declared both in Rust and in a WGSL file.
#[derive(Clone, Debug, PartialEq)]
pub struct Mirror {
    /// Name in Rust.
    pub rust: String,
    /// WGSL file by its name in `@use`.
    pub file: &'static str,
    /// Name in WGSL of the struct, constant or entry point.
    pub wgsl: String,
    /// Declaration in Rust.
    pub value: MirrorValue,
}

/// Declaration in Rust of a [`Mirror`].
#[derive(Clone, Debug, PartialEq)]
pub enum MirrorValue {
    /// Struct that is uploaded.
    Struct {
        /// Size in bytes.
        size: usize,
        /// Members in order.
        members: Vec<MirrorMember>,
    },
    /// Struct of a vertex buffer: members are attributes in order of their locations.
    Vertex(Vec<MirrorMember>),
    /// Components of a constant.
    Constant(Vec<f64>),
    /// Override that pipelines set by name.
    Override,
    /// Size of a workgroup.
    Workgroup([u32; 3]),
}

/// Member of a struct in Rust.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MirrorMember {
    /// Name.
    pub name: &'static str,
    /// Bytes from the start of the struct.
    pub offset: usize,
    /// Size in bytes.
    pub size: usize,
}

/// A struct that repeats a WGSL struct; implemented by [`crate::wgsl_struct`].
pub trait MirrorsWgsl {
    /// Returns the layout of the struct, and the name of the WGSL struct.
    fn mirror() -> Mirror;
}

impl Mirror {
    /// Describes a constant that is declared in both languages.
    pub fn constant(
        rust: &str,
        file: &'static str,
        wgsl: &str,
        value: impl IntoIterator<Item = impl Into<f64>>,
    ) -> Mirror {
        Mirror {
            rust: rust.to_owned(),
            file,
            wgsl: wgsl.to_owned(),
            value: MirrorValue::Constant(value.into_iter().map(Into::into).collect()),
        }
    }

    /// Describes an override that pipelines set.
    pub fn switch(rust: &str, file: &'static str, wgsl: &str) -> Mirror {
        Mirror {
            rust: rust.to_owned(),
            file,
            wgsl: wgsl.to_owned(),
            value: MirrorValue::Override,
        }
    }

    /// Describes the workgroup size of an entry point.
    pub fn workgroup(rust: &str, file: &'static str, wgsl: &str, size: [u32; 3]) -> Mirror {
        Mirror {
            rust: rust.to_owned(),
            file,
            wgsl: wgsl.to_owned(),
            value: MirrorValue::Workgroup(size),
        }
    }

    /// Lists differences from a module that contains the file, each as a sentence.
    pub fn differences(&self, module: &Reflection) -> Vec<String> {
        let Mirror { rust, file, wgsl, .. } = self;
        let found = match &self.value {
            MirrorValue::Struct { size, members } => module
                .structs
                .get(wgsl)
                .map(|layout| struct_differences(*size, members, layout)),
            MirrorValue::Vertex(members) => module
                .structs
                .get(wgsl)
                .map(|layout| vertex_differences(members, layout)),
            MirrorValue::Constant(value) => module.constants.get(wgsl).map(|theirs| difference(value, theirs)),
            MirrorValue::Override => module.overrides.get(wgsl).map(|_| Vec::new()),
            MirrorValue::Workgroup(size) => module.workgroups.get(wgsl).map(|theirs| difference(size, theirs)),
        };
        let differences = found.unwrap_or_else(|| vec!["it does not exist in WGSL".to_owned()]);
        differences
            .into_iter()
            .map(|what| format!("{rust} and `{wgsl}` of {file}.wgsl differ: {what}."))
            .collect()
    }
}

fn difference<T: Debug + PartialEq>(ours: &T, theirs: &T) -> Vec<String> {
    if ours == theirs {
        Vec::new()
    } else {
        vec![format!("{ours:?} in Rust, {theirs:?} in WGSL")]
    }
}

/// Lists differences in size, and in names, offsets and sizes of members. Padding is not compared, since the offsets of the
/// other members depend on it.
fn struct_differences(size: usize, members: &[MirrorMember], layout: &StructLayout) -> Vec<String> {
    let ours = members.iter().map(|member| (member.name, member.offset, member.size));
    let theirs = layout
        .members
        .iter()
        .map(|member| (member.name.as_str(), member.offset as usize, member.size as usize));
    let is_filled = |(name, ..): &(&str, usize, usize)| !name.starts_with(PADDING);
    let mut differences = difference(&size, &(layout.size as usize));
    differences.extend(difference(
        &ours.filter(is_filled).collect::<Vec<_>>(),
        &theirs.filter(is_filled).collect::<Vec<_>>(),
    ));
    differences
}

/// Lists differences in names, locations and sizes of vertex attributes.
fn vertex_differences(members: &[MirrorMember], layout: &StructLayout) -> Vec<String> {
    let ours = (0..).zip(members);
    let ours = ours.map(|(location, member)| (member.name, Some(location), member.size));
    let theirs = layout
        .members
        .iter()
        .map(|member| (member.name.as_str(), member.location, member.size as usize));
    difference(&ours.collect::<Vec<_>>(), &theirs.collect::<Vec<_>>())
}

/// Declares an uploaded struct together with the WGSL struct that it repeats:
///
/// ```ignore
/// wgsl_struct! {
/// "surface/share" Share:
/// /// Constants of one pass.
/// struct Constants {
/// group_count: u32,
/// }
/// }
/// ```
///
/// `vertex` in front of the file's name declares a struct of a vertex buffer.
#[macro_export]
macro_rules! wgsl_struct {
    (
        $file:literal $wgsl:ident:
        $(#[$meta:meta])*
        $vis:vis struct $name:ident { $($(#[$member_meta:meta])* $member_vis:vis $member:ident: $ty:ty,)* }
    ) => {
        $crate::wgsl_struct!(@declare $(#[$meta])* $vis struct $name {
            $($(#[$member_meta])* $member_vis $member: $ty,)*
        });
        $crate::wgsl_struct!(@mirror $file $wgsl $name $crate::link::MirrorValue::Struct {
            size: size_of::<$name>(),
            members: $crate::wgsl_struct!(@members $name { $($member: $ty,)* }),
        });
    };
    (
        vertex $file:literal $wgsl:ident:
        $(#[$meta:meta])*
        $vis:vis struct $name:ident { $($(#[$member_meta:meta])* $member_vis:vis $member:ident: $ty:ty,)* }
    ) => {
        $crate::wgsl_struct!(@declare $(#[$meta])* $vis struct $name {
            $($(#[$member_meta])* $member_vis $member: $ty,)*
        });
        $crate::wgsl_struct!(@mirror $file $wgsl $name $crate::link::MirrorValue::Vertex(
            $crate::wgsl_struct!(@members $name { $($member: $ty,)* })
        ));
    };
    (@declare $(#[$meta:meta])* $vis:vis struct $name:ident { $($body:tt)* }) => {
        $(#[$meta])*
        #[repr(C)]
        #[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
        $vis struct $name { $($body)* }
    };
    (@mirror $file:literal $wgsl:ident $name:ident $value:expr) => {
        impl $crate::link::MirrorsWgsl for $name {
            fn mirror() -> $crate::link::Mirror {
                $crate::link::Mirror {
                    rust: stringify!($name).to_owned(),
                    file: $file,
                    wgsl: stringify!($wgsl).to_owned(),
                    value: $value,
                }
            }
        }
    };
    (@members $name:ident { $($member:ident: $ty:ty,)* }) => {
        vec![$($crate::link::MirrorMember {
            name: stringify!($member),
            offset: std::mem::offset_of!($name, $member),
            size: size_of::<$ty>(),
        },)*]
    };
}

#[cfg(test)]
mod tests {
    use super::{Mirror, MirrorMember, MirrorValue};
    use crate::link::LinkedModule;

    fn mirror(value: MirrorValue, wgsl: &str) -> Mirror {
        Mirror {
            rust: "Ours".to_owned(),
            file: "surface/own",
            wgsl: wgsl.to_owned(),
            value,
        }
    }

    #[test]
    fn differences_from_the_shader_are_reported_by_name() {
        let mut module = LinkedModule::default();
        module.push_generated("const STEPS: u32 = 4u + 4u; struct Pair { first: vec3f, second: f32, pad: u32 }\n");
        let reflection = module.reflect().unwrap_or_else(|fault| panic!("{fault}"));
        let pair = |second, offset| MirrorValue::Struct {
            size: 32,
            members: vec![
                MirrorMember {
                    name: "first",
                    offset: 0,
                    size: 12,
                },
                MirrorMember {
                    name: second,
                    offset,
                    size: 4,
                },
            ],
        };
        let same = [
            mirror(pair("second", 12), "Pair"),
            mirror(MirrorValue::Constant(vec![8.0]), "STEPS"),
        ];
        for mirror in same {
            assert_eq!(mirror.differences(&reflection), [""; 0]);
        }
        let other = [
            (mirror(pair("third", 12), "Pair"), "third"),
            (mirror(pair("second", 16), "Pair"), "16"),
            (
                mirror(MirrorValue::Constant(vec![7.0]), "STEPS"),
                "[7.0] in Rust, [8.0] in WGSL",
            ),
            (mirror(MirrorValue::Override, "STEPS"), "it does not exist in WGSL"),
        ];
        for (mirror, expected) in other {
            let differences = mirror.differences(&reflection).join(" ");
            assert!(differences.contains(expected), "{differences}");
        }
    }
}
