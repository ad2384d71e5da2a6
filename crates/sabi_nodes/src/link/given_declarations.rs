//! Declarations that the host provides when it links a module: bind groups, storage formats, constants.

use std::fmt;

use super::Format;

/// Bind group of the surface in every kernel; required by `lib/atlas.wgsl`.
pub(crate) const SURFACE_GROUP: Given = Given::group("SURFACE_GROUP", 0);

/// Flag of kernels that run on points spread over the surface; required by `lib/surface.wgsl`. It is a constant in the
/// text, since software adapters execute both sides of a branch whose condition is known only at run time.
pub(crate) const fn on_points(holds: bool) -> Given {
    Given::flag("ON_POINTS", holds)
}

/// A declaration that a file requests with `@given`.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Given {
    /// Name that the file uses.
    pub name: &'static str,
    value: GivenValue,
}

#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum GivenValue {
    Flag(bool),
    Number(u32),
    StorageTexture(Format, Access),
}

/// Access of a kernel to a storage texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Access {
    /// Texels are written.
    Write,
    /// Texels are read and written.
    ReadWrite,
}

impl Given {
    /// Declares a condition that is known when the module is compiled.
    pub const fn flag(name: &'static str, holds: bool) -> Given {
        Given {
            name,
            value: GivenValue::Flag(holds),
        }
    }

    /// Declares a number that is known when the module is compiled.
    pub const fn number(name: &'static str, number: u32) -> Given {
        Given {
            name,
            value: GivenValue::Number(number),
        }
    }

    /// Declares the number of a bind group: `@group(NAME)`.
    pub const fn group(name: &'static str, number: u32) -> Given {
        Given::number(name, number)
    }

    /// Declares the type of a storage texture with several pages.
    pub const fn storage(name: &'static str, format: Format, access: Access) -> Given {
        Given {
            name,
            value: GivenValue::StorageTexture(format, access),
        }
    }
}

impl fmt::Display for Given {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = self.name;
        match self.value {
            GivenValue::Flag(holds) => writeln!(f, "const {name}: bool = {holds};"),
            GivenValue::Number(number) => writeln!(f, "const {name}: u32 = {number}u;"),
            GivenValue::StorageTexture(format, access) => {
                let access = match access {
                    Access::Write => "write",
                    Access::ReadWrite => "read_write",
                };
                writeln!(
                    f,
                    "alias {name} = texture_storage_2d_array<{}, {access}>;",
                    format.wgsl()
                )
            }
        }
    }
}
