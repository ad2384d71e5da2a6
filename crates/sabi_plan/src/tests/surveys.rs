//! Plans of nodes that read surveys, and of passes that exist for an input.

use super::{FUSED, TestPlanner, graph};
use crate::{Level, SlotExtent};

#[test]
fn a_survey_comes_before_the_pass_that_reads_it_and_before_the_results() {
    let lines = "
        a noise/simplex
        b adjust/coverage source=a
        out output/mask source=b";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    assert_eq!(
        plan.to_string(),
        "pass a -> s0\nsurvey b <- s0 -> s1\npass b <- s1 -> s2 once\npass b <- s0 s2 -> s3\nresult mask s3\n"
    );
    let extents: Vec<SlotExtent> = plan.slots.iter().map(|slot| slot.extent).collect();
    assert_eq!(
        extents,
        [
            SlotExtent::Level(Level::FINEST),
            SlotExtent::Survey,
            SlotExtent::Single,
            SlotExtent::Level(Level::FINEST)
        ]
    );
    let (_, errors) = TestPlanner::new().plan(&graph("b adjust/coverage\n out output/mask source=b"), FUSED);
    assert_eq!(errors.len(), 1, "what is surveyed has to be connected");
}

#[test]
fn a_survey_of_pieces_has_a_table_and_a_value_for_each() {
    let lines = "
        a noise/simplex
        b adjust/coverage source=a each=piece
        out output/mask source=b";
    let (plan, errors) = TestPlanner::new().plan(&graph(lines), FUSED);
    assert_eq!(errors, []);
    assert_eq!(
        plan.to_string(),
        "pass a -> s0\nsurvey b <- s0 -> s1 each piece\npass b <- s1 -> s2 for each group\npass b <- s0 s2 -> s3\nresult mask s3\n"
    );
    let extents: Vec<SlotExtent> = plan.slots.iter().map(|slot| slot.extent).collect();
    assert_eq!(
        extents,
        [
            SlotExtent::Level(Level::FINEST),
            SlotExtent::GroupSurvey,
            SlotExtent::Groups,
            SlotExtent::Level(Level::FINEST)
        ]
    );
}

#[test]
fn a_pass_that_is_for_an_input_runs_once_something_is_connected_or_set_there() {
    let passes = |blur: &str| {
        let lines = format!("a noise/simplex\nm noise/dots\nb filter/blur source=a {blur}\nout output/mask source=b");
        let (plan, errors) = TestPlanner::new().plan(&graph(&lines), FUSED);
        assert_eq!(errors, []);
        plan.passes()
    };
    let plain = passes("radius=0.016");
    assert_eq!(passes("radius=0.016 radius_map=1"), plain, "the default");
    // Six passes for each of three smaller radii.
    assert_eq!(passes("radius=0.016 radius_map=0.5"), plain + 18);
    assert_eq!(passes("radius=0.016 radius_map=m"), plain + 19);
}
