//! Members of groups, stored one group behind another.

/// Members of numbered groups. Members of a group are adjacent, in the order in which they were given.
#[derive(Clone, Debug, PartialEq)]
pub struct Groups {
    /// Start of each group in `members`, and the end of the last.
    starts: Vec<usize>,
    members: Vec<u32>,
}

impl Groups {
    /// Sorts members into `count` groups. `give` calls its argument with the group and the number of each member. It is
    /// called more than once, and must give the same members in the same order each time.
    pub fn new(count: usize, give: impl Fn(&mut dyn FnMut(usize, u32))) -> Groups {
        let mut starts = vec![0; count + 1];
        give(&mut |group, _| starts[group + 1] += 1);
        for group in 0..count {
            starts[group + 1] += starts[group];
        }
        let mut next = starts.clone();
        let mut members = vec![0; starts[count]];
        give(&mut |group, member| {
            members[next[group]] = member;
            next[group] += 1;
        });
        Groups { starts, members }
    }

    /// Sorts the numbers starting at 0 into `count` groups. `groups` contains the group of each number.
    pub fn of_each(groups: &[u32], count: usize) -> Groups {
        Groups::new(count, |member| {
            for (number, group) in groups.iter().enumerate() {
                member(*group as usize, number as u32);
            }
        })
    }

    /// Number of groups.
    pub fn count(&self) -> usize {
        self.starts.len() - 1
    }

    /// Members of a group.
    pub fn members(&self, group: usize) -> &[u32] {
        &self.members[self.starts[group]..self.starts[group + 1]]
    }
}

#[cfg(test)]
mod tests {
    use super::Groups;

    #[test]
    fn members_are_stored_by_group_in_the_given_order() {
        let groups = Groups::of_each(&[2, 0, 2, 0], 4);
        let all: Vec<&[u32]> = (0..groups.count()).map(|group| groups.members(group)).collect();
        assert_eq!(all, [&[1, 3][..], &[], &[0, 2], &[]]);
        assert_eq!(Groups::of_each(&[], 0).count(), 0);
    }

    #[test]
    fn a_member_can_be_in_several_groups() {
        let groups = Groups::new(2, |member| {
            for (group, number) in [(1, 7), (0, 7), (1, 3)] {
                member(group, number);
            }
        });
        assert_eq!((groups.members(0), groups.members(1)), (&[7][..], &[7, 3][..]));
    }
}
