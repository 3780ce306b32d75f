//! Tests of edits that keep the rest of a robot file unchanged.

use super::*;

/// A robot.toml with two tables.
const TEXT: &str =
    "[links]  # lengths\nl0 = 20.0 # base\nl1 = 30\nname = \"x\"\n[servo.A1]\nneutral = 1.5\n";

#[test]
fn only_the_number_changes() {
    let changed = with_number(TEXT, "links.l0", 21.5).expect("the key can be set");
    assert_eq!(changed, TEXT.replace("20.0", "21.5"));
    let changed = with_number(TEXT, "servo.A1.neutral", 2.0).expect("the key can be set");
    assert_eq!(changed, TEXT.replace("1.5", "2.0"));
}

#[test]
fn a_missing_optional_number_is_added_at_the_end_of_its_table() {
    const LEG: &str = "[leg] # legs\nground = 50.0 # lg10\n# hip_side = 35.0\n\n[servo]\n";
    let changed = with_number(LEG, "leg.hip_side", 36.0).expect("the optional key can be added");
    let expected = LEG.replace("# lg10\n", "# lg10\nhip_side = 36.0\n");
    assert_eq!(changed, expected);
    let changed_again = with_number(&changed, "leg.hip_side", 37.5).expect("the key can be set");
    assert_eq!(changed_again, expected.replace("36.0", "37.5"));
    // The lines of [servo.A1] do not belong to [servo].
    let servo = with_number(TEXT, "servo.volts", 4.5).expect("the optional key can be added");
    assert_eq!(servo, format!("{TEXT}\n[servo]\nvolts = 4.5\n"));
    for text in ["leg = { ground = 50.0 }", "leg.ground = 50.0", "[leg]"] {
        let text = &format!("{text}\n");
        assert!(with_number(text, "leg.hip_side", 36.0).is_err(), "{text}");
    }
}

#[test]
fn a_list_is_replaced_and_a_missing_list_is_added() {
    let changed = with_numbers("[body]\ncentre = [0, 0] # mm\n", "body.centre", &[1.5, 0.0]);
    assert_eq!(changed, Ok("[body]\ncentre = [1.5, 0.0] # mm\n".to_owned()));
    let added = with_numbers("[body]\nmass = 250.0\n", "body.centre", &[1.5, -2.0]);
    let expected = "[body]\nmass = 250.0\ncentre = [1.5, -2.0]\n";
    assert_eq!(added, Ok(expected.to_owned()));
    assert!(with_numbers(TEXT, "links.l0", &[1.0]).is_err());
    assert!(with_number("[body]\ncentre = [0, 0]\n", "body.centre", 1.0).is_err());
}

#[test]
fn a_comment_is_appended_or_replaces_one_with_the_same_first_word() {
    // Each text, divided at the place of the new comment.
    for (before, old_comment, after) in [
        ("[links]\nl0 = 1.0", "", ""),
        ("[links]\nl0 = 1.0 # base", "", "\n"),
        ("[links]\r\nl0 = 1.0", "", "\r\nl1 = 1\r\n"),
        ("[links]\nl0 = 1.0 # base", " # was: 3", "\n"),
        ("links = { l0 = 1.0, l1 = 2.0 }", "", "\n"),
    ] {
        let text = format!("{before}{old_comment}{after}");
        let commented = with_comment(&text, "links.l0", "was:", "2");
        assert_eq!(commented, Ok(format!("{before} # was: 2{after}")));
    }
    assert!(with_comment("[links]\nl0 = 1.0", "links.l1", "was:", "2").is_err());
}

#[test]
fn a_missing_table_is_added_at_the_end_of_the_text() {
    for text in ["[leg]\nground = 50.0\n", "[leg]\nground = 50.0"] {
        let changed = with_number(text, "body.mass", 250.0);
        let expected = "[leg]\nground = 50.0\n\n[body]\nmass = 250.0\n";
        assert_eq!(changed, Ok(expected.to_owned()));
    }
}

#[test]
fn a_key_is_removed_with_its_line() {
    const DRIVE: &str = "[leg.drive]\nkind = \"strut\"\nforce = 3.0 # N\nplay = 0.5\n";
    let shorter_text = without_key(DRIVE, "leg.drive.force").expect("the key can be removed");
    assert_eq!(shorter_text, "[leg.drive]\nkind = \"strut\"\nplay = 0.5\n");
    let same_text = without_key(&shorter_text, "leg.drive.force");
    assert_eq!(same_text, Ok(shorter_text));
    let inline_table = "[leg]\ndrive = { kind = \"strut\", force = 3.0 }\n";
    assert!(without_key(inline_table, "leg.drive.force").is_err());
}

#[test]
fn a_string_is_replaced_and_a_missing_string_is_added() {
    const DRIVE: &str = "[leg.drive] # links\nkind = \"rigid\" # or a strut\n";
    let changed = with_string(DRIVE, "leg.drive.kind", "strut").expect("the key can be set");
    assert_eq!(changed, DRIVE.replace("rigid", "strut"));
    let added = with_string("[leg]\nmount = 0.0\n", "leg.drive.kind", "strut");
    let expected = "[leg]\nmount = 0.0\n\n[leg.drive]\nkind = \"strut\"\n";
    assert_eq!(added, Ok(expected.to_owned()));
    assert!(with_string("[leg]\nmount = 0.0\n", "leg.mount", "x").is_err());
}

#[test]
fn only_the_tables_of_a_gait_are_removed_or_replaced() {
    const GAITS: &str = "[gait.look]\nperiod = 4.0\n[gait.look.head]\nx = [[1.0, 0.0]]\n# next table\n[gait.look-up]\nlike = \"walk\"\n";
    let rest = "# next table\n[gait.look-up]\nlike = \"walk\"\n";
    assert_eq!(without_gait(GAITS, "look"), rest);
    assert_eq!(without_gait(rest, "look"), rest);
    let [windows_gaits, windows_rest] = [GAITS, rest].map(|text| text.replace('\n', "\r\n"));
    assert_eq!(without_gait(&windows_gaits, "look"), windows_rest);
    let replaced = with_gait(GAITS, "look", "[gait.look]\nperiod = 5.0\n");
    assert_eq!(replaced, format!("[gait.look]\nperiod = 5.0\n{rest}"));
}

/// A robot.toml with two routines.
const ROUTINES: &str = "name = \"x\"\n\n[routine.patrol] # by night\nsteps = [\n  \"walk 4\", # on\n  \"left 6\",\n]\nrepeat = 3 # rounds\n\n[routine.about]\nsteps = ['left 12']\n";

/// Reads the names and steps of a text's routines.
fn read_names_and_steps(text: &str) -> Vec<(String, Vec<String>)> {
    let to_pair = |routine: WrittenRoutine| (routine.name, routine.steps);
    read_routines(text).into_iter().map(to_pair).collect()
}

/// Copies steps to owned strings.
fn to_strings(steps: &[&str]) -> Vec<String> {
    steps.iter().map(ToString::to_string).collect()
}

#[test]
fn routines_are_read_unchanged_in_the_order_of_the_text() {
    let [patrol, about] = ["patrol", "about"].map(str::to_string);
    let expected = [
        (patrol, to_strings(&["walk 4", "left 6"])),
        (about, to_strings(&["left 12"])),
    ];
    assert_eq!(read_names_and_steps(ROUTINES), expected);
    for text in [
        "[routine",
        "",
        "routine = 3",
        "[routine]\na = 1",
        "[routine.a]\nsteps = [1]",
    ] {
        assert_eq!(read_names_and_steps(text), [], "{text}");
    }
}

#[test]
fn only_the_steps_of_a_routine_are_replaced() {
    let steps = to_strings(&["walk until \"nose\"", "wait\\", "rest"]);
    let changed = with_steps(ROUTINES, "patrol", &steps);
    assert_eq!(read_names_and_steps(&changed)[0].1, steps);
    let start = ROUTINES.find("[\n").expect("the text has a list of steps");
    assert!(changed.starts_with(&ROUTINES[..start]));
    let end = ROUTINES.find("\nrepeat").expect("the routine is repeated");
    assert!(changed.ends_with(&ROUTINES[end..]));
}

#[test]
fn missing_steps_are_added_below_the_header() {
    let text = format!("{ROUTINES}[routine.empty] # new\nrepeat = 2\n[ground]\n");
    let expected = text.replace("# new\n", "# new\nsteps = [\"rest\"]\n");
    assert_eq!(with_steps(&text, "empty", &to_strings(&["rest"])), expected);
    let text = "[routine.empty]";
    let added = with_steps(text, "empty", &to_strings(&["rest"]));
    assert_eq!(added, "[routine.empty]\nsteps = [\"rest\"]");
}

#[test]
fn a_new_routine_is_added_at_the_end_of_the_text() {
    for text in [ROUTINES, ROUTINES.trim_end()] {
        let added = with_steps(text, "new-one", &to_strings(&["walk 1"]));
        let expected = format!("{ROUTINES}\n[routine.new-one]\nsteps = [\"walk 1\"]\n");
        assert_eq!(added, expected);
    }
    for name in ["", "a b", "a]\n[b", "\"", "x.y"] {
        let added = with_steps(ROUTINES, name, &to_strings(&["walk 1"]));
        assert_eq!(read_names_and_steps(&added)[2].0, name);
    }
}

#[test]
fn unknown_keys_and_values_of_another_type_are_rejected() {
    for key in ["links.l2", "links.name", "wings.l0", "links", "servo.A1"] {
        assert!(with_number(TEXT, key, 1.0).is_err(), "{key}");
    }
    assert!(with_number("[links", "links.l0", 1.0).is_err());
}
