//! Parameters of sources, which have no WGSL file that describes them.

use super::{Memory, Param, ParamType, ParamValue, Role, shortest_decimal};
use crate::names::label_of;

impl Param {
    /// Creates a parameter of a source. `doc` describes its visible effect.
    fn of_source(name: &str, doc: &str, memory: Memory, role: Role, default: ParamValue) -> Param {
        Param {
            name: name.to_owned(),
            label: label_of(name),
            doc: doc.to_owned(),
            ty: ParamType::new(role, memory, &default),
            offset: 0,
            default,
            bounds_a_loop: false,
            takes_mask: false,
            is_absolute: false,
            formerly: Vec::new(),
        }
    }

    /// Creates a text parameter.
    pub fn text(name: &str, default: &str, doc: &str) -> Param {
        let default = ParamValue::Text(default.to_owned());
        Param::of_source(name, doc, Memory::Text, Role::Text, default)
    }

    /// Creates a parameter that holds the path of a file, empty by default.
    pub fn file(name: &str, doc: &str) -> Param {
        let default = ParamValue::Text(String::new());
        Param::of_source(name, doc, Memory::Text, Role::File, default)
    }

    /// Creates a choice of words; the first is the default.
    pub fn choice(name: &str, words: &[&str], doc: &str) -> Param {
        let role = Role::Choice(words.iter().map(|word| (*word).to_owned()).collect());
        Param::of_source(name, doc, Memory::U32, role, ParamValue::Unsigned(0))
    }

    /// Creates a parameter that is on or off.
    pub fn toggle(name: &str, default: bool, doc: &str) -> Param {
        let default = ParamValue::Unsigned(u32::from(default));
        Param::of_source(name, doc, Memory::U32, Role::Toggle, default)
    }

    /// Creates a seed, which the engine receives hashed with the seeds of the document and of the enclosing groups.
    pub fn seed(name: &str, doc: &str) -> Param {
        Param::of_source(name, doc, Memory::U32, Role::Seed, ParamValue::Unsigned(0))
    }

    /// Creates a number.
    pub fn number(name: &str, default: f32, doc: &str) -> Param {
        Param::of_source(name, doc, Memory::F32, Role::Plain, ParamValue::Floats(vec![default]))
    }

    /// Creates a length in working units.
    pub fn length(name: &str, default: f32, doc: &str) -> Param {
        Param::of_source(name, doc, Memory::F32, Role::Length, ParamValue::Floats(vec![default]))
    }

    /// Creates an angle in degrees, which the engine receives in radians.
    pub fn angle(name: &str, default: f32, doc: &str) -> Param {
        Param::of_source(name, doc, Memory::F32, Role::Angle, ParamValue::Floats(vec![default]))
    }

    /// Creates a parameter with two numbers.
    pub fn pair(name: &str, default: [f32; 2], doc: &str) -> Param {
        let default = ParamValue::Floats(default.to_vec());
        Param::of_source(name, doc, Memory::Vec2, Role::Plain, default)
    }

    /// Creates a direction, or three numbers without a unit.
    pub fn vector(name: &str, default: [f32; 3], doc: &str) -> Param {
        let default = ParamValue::Floats(default.to_vec());
        Param::of_source(name, doc, Memory::Vec3, Role::Plain, default)
    }

    /// Creates three lengths in working units: a position, or the sides of a box.
    pub fn lengths(name: &str, default: [f32; 3], doc: &str) -> Param {
        let default = ParamValue::Floats(default.to_vec());
        Param::of_source(name, doc, Memory::Vec3, Role::Length, default)
    }

    /// Sets the range. Values outside are refused.
    #[must_use]
    pub fn within(mut self, low: f32, high: f32) -> Param {
        self.ty.range = Some([low, high].map(shortest_decimal));
        self
    }

    /// Sets the name that artists see.
    #[must_use]
    pub fn labeled(mut self, label: &str) -> Param {
        label.clone_into(&mut self.label);
        self
    }

    /// Sets the ends of the slider.
    #[must_use]
    pub fn with_slider(mut self, low: f32, high: f32) -> Param {
        self.ty.soft = Some([low, high].map(shortest_decimal));
        self
    }
}
