//! Plans in which every value has a slot of its own.

use super::{TestPlanner, UNFUSED, graph};

#[test]
fn each_value_has_a_slot_of_its_own_on_request() {
    let lines = "
        a noise/simplex
        b adjust/invert source=a
        c adjust/invert source=b
        d adjust/invert source=c
        out output/mask source=d";
    let (plan, _) = TestPlanner::new().plan(&graph(lines), UNFUSED);
    let expected = "\
        pass a -> s0\n\
        pass b <- s0 -> s1\n\
        pass c <- s1 -> s2\n\
        pass d <- s2 -> s3\n\
        result mask s3\n";
    let own = plan.with_own_slots();
    assert_eq!((own.to_string().as_str(), own.slots.len()), (expected, 4));
}
