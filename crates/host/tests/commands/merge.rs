//! Tests of long computations that are split into parts: independent processes compute the parts, and `lizard merge`
//! prints the output of a single process. `make parallel-test` repeats this with GNU parallel and longer commands.

use crate::harness::{expect_refusals, repo_root, run_line, with_paper};

/// Computes all parts and returns their output, the last part first.
fn compute_parts(arguments: &str, part_count: usize) -> String {
    let compute_part = |number| {
        run_line(&format!("{arguments} --part {number}/{part_count}"), "").expect_success()
    };
    (1..=part_count).rev().map(compute_part).collect()
}

#[test]
fn merge_prints_the_output_of_a_single_process() {
    for (arguments, part_count) in [
        ("prove --one-in 30000", 3),
        ("prove --one-in 30000 --json", 2),
        ("design --search --step 0.05", 2),
        // There are more parts than items to compute.
        ("design --search --step 0.1 --top 3 --json", 5),
    ] {
        let arguments = with_paper(arguments);
        let single_output = run_line(&arguments, "").expect_success();
        assert!(single_output.len() > 100, "{arguments}: {single_output}");
        let merge = run_line("merge", compute_parts(&arguments, part_count));
        assert_eq!(merge.expect_success(), single_output, "{arguments}");
    }
}

#[test]
fn merge_refuses_parts_that_are_not_one_complete_computation() {
    let arguments = with_paper("design --search --step 0.1");
    let parts = compute_parts(&arguments, 2);
    let (last_part, first_part) = parts.split_once('\n').expect("the parts are two lines");
    let merge_with_last_part =
        |other_part: &str| run_line("merge", format!("{last_part}\n{other_part}"));
    merge_with_last_part("").expect_refusal_with("lizard: part 1/2 is missing");
    let other_line = "design --search --step 0.1 --robot robots/unequal.toml --part 1/2";
    let part_of_other_robot = run_line(other_line, "").expect_success();
    merge_with_last_part(&part_of_other_robot)
        .expect_refusal_with("lizard: part 1/2 has a different robot from another part");
    let other_line = with_paper("design --search --step 0.2 --part 1/2");
    let part_of_other_step = run_line(&other_line, "").expect_success();
    merge_with_last_part(&part_of_other_step).expect_refusal_with("different options");
    // A killed job leaves a partial line.
    let partial_line = &first_part[..first_part.len() / 2];
    merge_with_last_part(partial_line)
        .expect_refusal_with("lizard: standard input: line 2 is not a part: ...");
    let cases = "
        merge => no parts given
        merge no-such-part => lizard: cannot read no-such-part: ...
    ";
    expect_refusals(&repo_root(), cases);
}

#[test]
fn the_option_part_needs_a_valid_number_and_a_command_that_can_be_split() {
    let cases = "
        prove --part 3/2 => expected K/N with K from 1 to N
        design --part 1/2 --robot robots/paper.toml => --part requires --search
    ";
    expect_refusals(&repo_root(), cases);
}
