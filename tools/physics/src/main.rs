//! `make physics`: walks every gait of every file of robots/ by the contact model and by MuJoCo.
//! With `--write` the new results replace the stored ones; with `--one-in N` only every N-th gait
//! is walked.

use std::process::ExitCode;

use lizard_physics::mujoco::{Jobs, MujocoError};
use lizard_physics::{Answers, Figures, ROBOTS, Row, here, robot, rows, table};
use lizard_robot::Robot;

/// A difference from the stored answer, mm and deg, beyond which the model, the engine or the robot
/// must have changed.
const SAME: (f64, f64) = (0.6, 0.4);

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let one_in = match &words[..] {
        [] => Some(1),
        [write] if write == "--write" => None,
        [flag, n] if flag == "--one-in" && n.parse().is_ok_and(|n: usize| n > 0) => n.parse().ok(),
        _ => {
            eprintln!("physics: --write, or --one-in and a number from 1 on, not {words:?}");
            return ExitCode::from(2);
        }
    };
    match run(one_in) {
        Ok(faults) if faults.is_empty() => {
            println!("physics: model and MuJoCo agree");
            ExitCode::SUCCESS
        }
        Ok(faults) => {
            for fault in &faults {
                println!("FAULT {fault}");
            }
            println!("physics: {} faults", faults.len());
            ExitCode::FAILURE
        }
        Err(error) => {
            eprintln!("physics: {error}");
            ExitCode::FAILURE
        }
    }
}

/// The file's name for a row of a robot.
fn name(robot: &str, place: usize) -> String {
    format!("{robot}-{place}")
}

/// Walks one of so many gaits, or all, whose answers are stored, for `None`. Returns the faults.
fn run(one_in: Option<usize>) -> Result<Vec<String>, MujocoError> {
    let (write, one_in) = (one_in.is_none(), one_in.unwrap_or(1));
    let robots: Vec<(&str, Robot)> = ROBOTS.map(|name| (name, robot(name))).into();
    let mut number = 0..;
    let mut is_one = || {
        number
            .next()
            .is_some_and(|n: usize| n.is_multiple_of(one_in))
    };
    let all: Vec<Vec<Row>> = robots
        .iter()
        .map(|(_, robot)| rows(robot).into_iter().filter(|_| is_one()).collect())
        .collect();
    let mut jobs = Jobs::new()?;
    for ((of, robot), rows) in robots.iter().zip(&all) {
        let named = rows.iter().enumerate();
        jobs.add(robot, named.map(|(place, row)| (name(of, place), row)))?;
    }
    println!(
        "physics: {} walks by MuJoCo take some minutes",
        jobs.count()
    );
    let by_mujoco = jobs.start()?.done()?;

    let (kept, mut found, mut faults) = (Figures::kept(), Figures::default(), Vec::new());
    for ((of, robot), rows) in robots.iter().zip(&all) {
        for (place, row) in rows.iter().enumerate() {
            let answers = Answers {
                model: row.model(robot),
                mujoco: by_mujoco[&name(of, place)],
            };
            let mut words: Vec<String> = answers.disagreement(row.case).into_iter().collect();
            if !write {
                words.extend(changed(kept.get(of, &row.gait, row.case), &answers));
            }
            let what = |words| format!("{of}: {} ({}): {words}", row.gait, row.case);
            faults.extend(words.into_iter().map(what));
            found.put(of, &row.gait, row.case, answers);
        }
        println!("\n{}", table(of, robot, &found));
    }
    if write {
        std::fs::write(here().join("figures.json"), found.text())?;
        println!(
            "physics: written to tools/physics/figures.json; `make docs` puts it into the pages"
        );
    } else if one_in == 1 && kept.count() != found.count() {
        faults.push(format!(
            "{} figures are kept, and there are {}; `make physics WRITE=1` keeps these",
            kept.count(),
            found.count()
        ));
    }
    Ok(faults)
}

/// The sentences for answers that differ from the stored ones.
fn changed(kept: Option<&Answers>, now: &Answers) -> Vec<String> {
    let Some(before) = kept else {
        return vec!["no figures are kept; `make physics WRITE=1` keeps these".to_owned()];
    };
    // Results that depend on ties differ between machines.
    let (Some(was), Some(is)) = (before.model, now.model) else {
        return Vec::new();
    };
    let all = [
        ("the model", was, is),
        ("MuJoCo", before.mujoco, now.mujoco),
    ];
    let changed = all.into_iter().filter_map(|(who, before, now)| {
        let (mm, deg) = before.distance_to(&now);
        (mm > SAME.0 || deg > SAME.1).then(|| {
            format!("{who} differs by {mm:.1} mm and {deg:.1} deg from what is kept; if that is meant, `make physics WRITE=1`")
        })
    });
    changed.collect()
}
