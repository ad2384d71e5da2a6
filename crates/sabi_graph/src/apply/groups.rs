//! Edits of groups as a whole.

use super::{make_canonical, missing};
use crate::document::GroupDef;
use crate::name::check_name;
use crate::problem::{listed, quoted};
use crate::validate;
use crate::{Document, Edit, EditError, GROUP_KIND};

impl Document {
    pub(super) fn add_group(&mut self, name: String, group: GroupDef) -> Result<Edit, EditError> {
        check_name("group", &name, "")?;
        if self.groups.contains_key(&name) {
            return Err(EditError::GroupExists { name: quoted(&name) });
        }
        let group = self.checked_group(&name, group)?;
        self.groups.insert(name.clone(), group);
        Ok(Edit::RemoveGroup { name })
    }

    pub(super) fn set_group(&mut self, name: String, group: GroupDef) -> Result<Edit, EditError> {
        if !self.groups.contains_key(&name) {
            return Err(missing("group", &name, self.groups.keys()));
        }
        let group = self.checked_group(&name, group)?;
        match self.groups.insert(name.clone(), group) {
            Some(before) => Ok(Edit::SetGroup {
                name,
                group: Box::new(before),
            }),
            None => Err(missing("group", &name, self.groups.keys())),
        }
    }

    /// Returns a group with canonical values if it can be added to the document under this name.
    fn checked_group(&self, name: &str, mut group: GroupDef) -> Result<GroupDef, EditError> {
        validate::group_ports(&group)?;
        for (_, node) in group.graph.nodes() {
            let is_group = |used: &str| used == name || self.groups.contains_key(used);
            validate::kind_and_group(node, is_group, self.groups.keys().map(String::as_str))?;
        }
        group.fit = match group.fit {
            Some(fit) => Some(validate::fit(fit).ok_or(EditError::BadFit)?),
            None => None,
        };
        make_canonical(&mut group.extra)?;
        for input in group.inputs.values_mut() {
            make_canonical(&mut input.extra)?;
        }
        Ok(group)
    }

    pub(super) fn remove_group(&mut self, name: String) -> Result<Edit, EditError> {
        let users = self.instances_of(&name);
        if !users.is_empty() {
            return Err(EditError::GroupInUse {
                name: quoted(&name),
                users: listed(users.iter().map(String::as_str)),
            });
        }
        match self.groups.remove(&name) {
            Some(group) => Ok(Edit::AddGroup {
                name,
                group: Box::new(group),
            }),
            None => Err(missing("group", &name, self.groups.keys())),
        }
    }

    /// Returns the instances of a group outside the group itself, as `node` or `group/node`.
    fn instances_of(&self, name: &str) -> Vec<String> {
        let main = std::iter::once((None, &self.graph));
        let groups = self.groups.iter().filter(|(group, _)| *group != name);
        main.chain(groups.map(|(group, def)| (Some(group), &def.graph)))
            .flat_map(|(group, graph)| graph.nodes().map(move |(id, node)| (group, id, node)))
            .filter(|(_, _, node)| node.kind == GROUP_KIND && node.group.as_deref() == Some(name))
            .map(|(group, id, _)| match group {
                None => id.to_string(),
                Some(group) => format!("{group}/{id}"),
            })
            .collect()
    }

    /// Renames a group and its instances, also instances inside the group itself: flattening refuses those, but editing keeps them.
    pub(super) fn rename_group(
        &mut self,
        name: String,
        to: String,
        shown_as: Option<String>,
    ) -> Result<Edit, EditError> {
        check_name("group", &to, "")?;
        if !self.groups.contains_key(&name) {
            return Err(missing("group", &name, self.groups.keys()));
        }
        // Instances of a group file with the new name would become instances of this group, and the inverse could not tell them apart.
        if to != name && (self.groups.contains_key(&to) || !self.instances_of(&to).is_empty()) {
            return Err(EditError::GroupExists { name: quoted(&to) });
        }
        let Some(mut group) = self.groups.remove(&name) else {
            return Err(missing("group", &name, self.groups.keys()));
        };
        let before = std::mem::replace(&mut group.name, shown_as);
        self.groups.insert(to.clone(), group);
        let inner = self.groups.values_mut().map(|group| &mut group.graph);
        for graph in std::iter::once(&mut self.graph).chain(inner) {
            for (_, node) in graph.net.node_weights_mut() {
                if node.kind == GROUP_KIND && node.group.as_deref() == Some(name.as_str()) {
                    node.group = Some(to.clone());
                }
            }
        }
        Ok(Edit::RenameGroup {
            name: to,
            to: name,
            shown: before,
        })
    }
}
