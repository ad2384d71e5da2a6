//! Random values of exposed parameters, and the parameters that they leave alone.

use std::collections::BTreeSet;

use egui::Ui;
use egui_phosphor::regular as icon;

/// Parameters that random values leave alone, by the graph or node that has them.
pub(super) type LockedParameters<K> = BTreeSet<(K, String)>;

/// Shows *Random* and *Keep* for the parameters of `of`, given by name and label. Returns the names of those that are kept, if
/// random values are wanted.
pub(super) fn show<K: Ord + Clone>(
    ui: &mut Ui,
    of: &K,
    knobs: &[(&str, &str)],
    kept: &mut LockedParameters<K>,
) -> Option<BTreeSet<String>> {
    let mut is_wanted = false;
    ui.horizontal_wrapped(|ui| {
        let random = ui.button(format!("{} Random", icon::DICE_FIVE));
        is_wanted = random
            .on_hover_text("Other patterns, and other values near the present ones")
            .clicked();
        let keep = ui.menu_button(format!("{} Keep", icon::LOCK_SIMPLE), |ui| {
            for (name, label) in knobs {
                let key = (of.clone(), (*name).to_owned());
                let mut is_kept = kept.contains(&key);
                if ui.checkbox(&mut is_kept, *label).changed() {
                    match is_kept {
                        true => kept.insert(key),
                        false => kept.remove(&key),
                    };
                }
            }
        });
        keep.response.on_hover_text("Parameters that Random leaves alone");
    });
    is_wanted.then(|| {
        let own = kept.iter().filter(|(known, _)| known == of);
        own.map(|(_, name)| name.clone()).collect()
    })
}
