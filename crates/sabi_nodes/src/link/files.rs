//! Modules of Sabi's own shader files.

use super::given_declarations::Given;
use super::module::LinkedModule;
use super::uses::FileUses;
use crate::fault::Fault;
use crate::shader_files::{Libraries, shared_path};

/// Sources of a module that is part of Sabi itself.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct ModuleSpec {
    /// Name in messages and debuggers.
    pub label: &'static str,
    /// Files by their names in `@use`. The files that they use are added.
    pub files: Vec<&'static str>,
    /// Declarations that the files expect from the host.
    pub given: Vec<Given>,
}

impl ModuleSpec {
    /// Links the files with the built-in libraries that they use.
    pub fn link(&self) -> Result<LinkedModule, Fault> {
        link_files(&self.files, &self.given, Libraries::builtin())
    }
}

/// Links shared files, and the files that they use, into one module.
pub(crate) fn link_files(files: &[&str], given: &[Given], libraries: &Libraries) -> Result<LinkedModule, Fault> {
    let mut uses = FileUses::new(libraries);
    for name in files {
        if !uses.add(name) {
            let message = format!("There is no shader file `{name}`.");
            return Err(Fault::of_file(&shared_path(name), message, ""));
        }
    }
    let mut module = LinkedModule::default();
    uses.append(&mut module, given)?;
    Ok(module)
}

#[cfg(test)]
mod tests {
    use super::{LinkedModule, link_files};
    use crate::Libraries;
    use crate::fault::Fault;
    use crate::link::{Access, Format, Given};
    use crate::shader_files::shader_names;

    /// Links files with exactly the declarations that they require.
    fn linked(files: &[&str]) -> Result<LinkedModule, Fault> {
        let group = Given::group("SURFACE_GROUP", 3);
        let field = Given::storage("StoredField", Format::R32Float, Access::ReadWrite);
        let on_points = Given::flag("ON_POINTS", false);
        let is_half = Given::flag("IS_HALF", true);
        let flag = |name| Given::flag(name, true);
        let of_field = [group.clone(), field.clone(), is_half.clone()];
        let with = |more: &[Given]| [of_field.as_slice(), more].concat();
        let storage = Given::number("STORAGE_0", 0);
        let projected = [Given::number("WAY", 0), flag("READS_PLACE")];
        let of_image = [
            storage.clone(),
            flag("SHOWS_SLOPE"),
            flag("HAS_CELLS"),
            flag("IS_RANDOM"),
        ];
        let others = ["STORAGE_1", "STORAGE_2", "STORAGE_3"].map(|name| Given::number(name, 0));
        let wanted = [
            vec![],
            vec![group.clone()],
            vec![field.clone()],
            vec![group.clone(), on_points],
            with(&[storage.clone(), flag("SHOWS_SLOPE")]),
            with(&[of_image.as_slice(), &projected].concat()),
            with(&[[storage].as_slice(), &others].concat()),
            with(&[Given::number("BY", 0), flag("HAS_BOXES")]),
            with(&[flag("IS_ALPHA")]),
            [[group.clone()].as_slice(), &projected].concat(),
            vec![is_half],
            vec![group, field],
        ];
        let tried = wanted.map(|given| link_files(files, &given, Libraries::builtin()));
        let [first, others @ ..] = tried;
        others.into_iter().fold(first, Result::or)
    }

    #[test]
    fn every_shared_file_names_everything_that_it_uses() {
        let names = Libraries::builtin().names().chain(shader_names());
        for name in names {
            // Files that compute ghosts do not fix where texels are read and written, so another file has to define it.
            let files = match name {
                "surface/fill_plain" | "surface/fill_coupled" => vec![name, "surface/access_in_place"],
                _ => vec![name],
            };
            let module = linked(&files).unwrap_or_else(|fault| panic!("{fault}"));
            module
                .check()
                .unwrap_or_else(|fault| panic!("{name} does not say all that it uses.\n{fault}"));
        }
    }

    fn with_library(name: &str, text: &str) -> Libraries {
        let mut libraries = Libraries::builtin().clone();
        libraries.0.insert(name.to_owned(), text.to_owned());
        libraries
    }

    #[test]
    fn a_missing_file_is_reported_where_it_is_used() {
        let libraries = with_library("own", "//! Own.\n//! @use hash nosie\n");
        let fault = link_files(&["own"], &[], &libraries).unwrap_err();
        assert_eq!(
            (fault.path.to_str(), fault.line, fault.column),
            (Some("lib/own.wgsl"), 2, 15)
        );
        assert_eq!(fault.message, "There is no library `nosie` that can be used.");
        assert!(fault.advice.starts_with("Did you mean `noise`?"), "{}", fault.advice);
        let fault = link_files(&["view/nothing"], &[], &libraries).unwrap_err();
        assert_eq!(
            fault.to_string(),
            "view/nothing.wgsl: There is no shader file `view/nothing`."
        );
    }

    #[test]
    fn a_library_uses_no_files_of_other_folders() {
        let libraries = with_library("own", "//! Own.\n//! @use surface/place\n");
        let fault = link_files(&["own"], &[], &libraries).unwrap_err();
        assert_eq!(fault.message, "There is no library `surface/place` that can be used.");
    }

    #[test]
    fn files_that_use_each_other_are_each_linked_once() {
        let mut libraries = with_library(
            "one",
            "//! @use two\nconst ONE: u32 = 1u;\nconst THREE: u32 = TWO + ONE;\n",
        );
        let two = "//! @use one\nconst TWO: u32 = ONE + ONE;\n";
        libraries.0.insert("two".to_owned(), two.to_owned());
        let module = link_files(&["one"], &[], &libraries).unwrap();
        assert_eq!(module.shared_files().collect::<Vec<_>>(), ["one", "two"]);
        module.check().unwrap();
    }

    #[test]
    fn exactly_the_required_declarations_must_be_given() {
        let group = Given::group("SURFACE_GROUP", 2);
        let fault = link_files(&["atlas"], &[], Libraries::builtin()).unwrap_err();
        assert_eq!(fault.message, "Nothing gives `SURFACE_GROUP` to this file.");
        assert!(fault.line > 1 && fault.path.ends_with("lib/atlas.wgsl"), "{fault}");
        let module = link_files(&["atlas"], std::slice::from_ref(&group), Libraries::builtin()).unwrap();
        assert!(module.wgsl().contains("const SURFACE_GROUP: u32 = 2u;"));
        let fault = link_files(&["hash"], &[group], Libraries::builtin()).unwrap_err();
        assert!(fault.message.contains("none of its files wants it"), "{fault}");
    }
}
