//! Names that are valid in MaterialX and USD: ASCII letters, digits and underscores, not starting with a digit.

use std::collections::BTreeSet;

/// Set of distinct identifiers.
#[derive(Debug, Default)]
pub(super) struct Identifiers {
    taken: BTreeSet<String>,
}

impl Identifiers {
    /// Creates a set in which these identifiers are taken.
    pub(super) fn without(taken: &[&str]) -> Identifiers {
        Identifiers {
            taken: taken.iter().map(|name| (*name).to_owned()).collect(),
        }
    }

    /// Returns the identifier for a name, followed by a number if an earlier name has the same one. A name without any
    /// ASCII letter or digit becomes `otherwise`, which is also put before a leading digit.
    pub(super) fn add(&mut self, name: &str, otherwise: &str) -> String {
        // Two consecutive underscores are not allowed in GLSL, to which MaterialX is compiled.
        let words = name.split(|letter: char| !letter.is_ascii_alphanumeric());
        let words: Vec<&str> = words.filter(|word| !word.is_empty()).collect();
        let mut wanted = match words.is_empty() {
            true => otherwise.to_owned(),
            false => words.join("_"),
        };
        if wanted.starts_with(|first: char| first.is_ascii_digit()) {
            wanted = format!("{otherwise}_{wanted}");
        }
        let mut found = wanted.clone();
        let mut number = 2_u32;
        while !self.taken.insert(found.clone()) {
            found = format!("{wanted}_{number}");
            number += 1;
        }
        found
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn any_name_becomes_a_unique_identifier() {
        let mut identifiers = Identifiers::without(&["Surface"]);
        let cases = [
            ("Leather Strap", "Leather_Strap"),
            ("Leather_Strap", "Leather_Strap_2"),
            ("Leather-Strap", "Leather_Strap_3"),
            ("2nd hand", "material_2nd_hand"),
            ("錆", "material"),
            ("寂", "material_2"),
            ("___", "material_3"),
            ("", "material_4"),
            ("__Türgriff", "T_rgriff"),
            ("a<b>&\"c\"@d_", "a_b_c_d"),
            ("Surface", "Surface_2"),
        ];
        for (name, expected) in cases {
            assert_eq!(identifiers.add(name, "material"), expected, "{name:?}");
        }
    }

    proptest! {
        #[test]
        fn identifiers_are_valid_and_different(names in proptest::collection::vec(".*", 0..20)) {
            let mut identifiers = Identifiers::default();
            let mut seen = BTreeSet::new();
            for name in &names {
                let identifier = identifiers.add(name, "map");
                prop_assert!(identifier.chars().all(|letter| letter.is_ascii_alphanumeric() || letter == '_'));
                prop_assert!(!identifier.starts_with(|first: char| first.is_ascii_digit()));
                prop_assert!(seen.insert(identifier));
            }
        }
    }
}
