//! Names that MaterialX and USD take: letters of ASCII, digits and lines, no digit first.

use std::collections::BTreeSet;

/// Identifiers that are all different.
#[derive(Debug, Default)]
pub(super) struct Identifiers {
    taken: BTreeSet<String>,
}

impl Identifiers {
    /// Identifiers of which these are taken.
    pub(super) fn without(taken: &[&str]) -> Identifiers {
        Identifiers {
            taken: taken.iter().map(|name| (*name).to_owned()).collect(),
        }
    }

    /// The identifier for a name, with a number behind it where an earlier name has the same. A name without any letter or digit
    /// of ASCII gets `otherwise`, and that stands before a digit.
    pub(super) fn add(&mut self, name: &str, otherwise: &str) -> String {
        // Two lines in a row are no name in GLSL, which MaterialX becomes.
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
    fn any_name_becomes_an_identifier_of_its_own() {
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
