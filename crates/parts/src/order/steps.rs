//! The steps of the assembly, from the plate to the first walk.
//!
//! A step is a section of the guide, with pictures if it adds bodies. It consists of successive stages, since some
//! parts are joined on the bench before they are mounted on the robot. `reach.rs` checks which screws can be reached in
//! which stage.
//!
//! A servo does not report its angle. It is therefore wired and driven to its middle before its link is pressed on, and
//! its direction is tested before the links are joined: until then, a wrong turn moves no other part.

use crate::layers::body::{Body, Kind, Mount};

/// Instructions of all steps, each below the step's title.
const INSTRUCTIONS: &str = include_str!("steps.md");

/// A step of the guide.
pub struct Step {
    /// Headline of the step.
    pub title: &'static str,
    /// Instructions as Markdown, with each paragraph in one line.
    pub instructions: String,
    /// Stages, each with the bodies to add and the screws to turn; empty for a step without bodies and screws.
    pub stages: Vec<Stage>,
    /// Lift of a body in the exploded picture, as a multiple of the standard lift; negative moves it down.
    pub lift: fn(&Body) -> f64,
    /// Extra picture, if any.
    pub extra_view: ExtraView,
}

/// A picture in addition to the two pictures of the complete robot.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ExtraView {
    /// No extra picture.
    None,
    /// The front left corner alone.
    Corner,
    /// The front left corner, from below.
    CornerBelow,
    /// The complete robot, from below.
    Below,
}

/// A stage of a step: bodies that are added together.
pub struct Stage {
    /// Place where the stage's screws are turned.
    pub turning_place: TurningPlace,
    /// True for a body that the stage adds unless an earlier stage has added it.
    pub adds: fn(&Body) -> bool,
    /// True for a screw of an earlier stage that is turned again.
    pub turns_again: fn(&Body) -> bool,
}

/// The place where a stage's screws are turned.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum TurningPlace {
    /// On the robot, among all bodies added so far.
    Robot,
    /// On the bench, among the bodies of the screw's servos that the current step has added.
    Bench,
}

impl Step {
    /// True for a body that this step adds.
    pub fn adds(&self, body: &Body) -> bool {
        self.stages.iter().any(|stage| (stage.adds)(body))
    }
}

/// Finds the numbers of the step and of the stage that add a body, each from 1; zeros if no step adds the body.
pub(crate) fn find_step_and_stage(steps: &[Step], body: &Body) -> (usize, usize) {
    for (number, step) in (1..).zip(steps) {
        if let Some(stage) = step.stages.iter().position(|stage| (stage.adds)(body)) {
            return (number, stage + 1);
        }
    }
    (0, 0)
}

/// True if a body's name starts with one of the prefixes.
fn has_name_prefix(body: &Body, prefixes: &[&str]) -> bool {
    prefixes.iter().any(|prefix| body.name.starts_with(prefix))
}

/// Creates a stage on the robot, without screws that are turned again.
fn robot_stage(adds: fn(&Body) -> bool) -> Stage {
    Stage {
        turning_place: TurningPlace::Robot,
        adds,
        turns_again: |_| false,
    }
}

/// Creates a stage on the bench, without screws that are turned again.
fn bench_stage(adds: fn(&Body) -> bool) -> Stage {
    Stage {
        turning_place: TurningPlace::Bench,
        ..robot_stage(adds)
    }
}

/// Builds a step with the instructions below its title in `steps.md`.
fn build_step(
    title: &'static str,
    lift: fn(&Body) -> f64,
    extra_view: ExtraView,
    stages: Vec<Stage>,
) -> Step {
    let sections = INSTRUCTIONS.split("## ");
    let mut sections = sections.filter_map(|section| section.split_once('\n'));
    let section = sections.find(|(headline, _)| *headline == title);
    let (_, text) = section.expect("each title is in steps.md");
    let paragraphs = text.trim().split("\n\n");
    let paragraphs = paragraphs.map(|paragraph| paragraph.replace('\n', " "));
    let instructions = paragraphs.collect::<Vec<_>>().join("\n\n");
    Step {
        title,
        instructions,
        stages,
        lift,
        extra_view,
    }
}

/// Builds a step that adds no bodies and turns no screws, such as a step at the console.
fn step_without_stages(title: &'static str) -> Step {
    build_step(title, |_| 0.0, ExtraView::None, Vec::new())
}

/// Builds the steps for a robot with slotted or with rigid struts.
pub fn build_steps(has_slotted_struts: bool) -> Vec<Step> {
    vec![
        chassis_step(),
        supply_step(),
        board_step(),
        step_without_stages("Flash the board"),
        links_step(),
        step_without_stages("Check the signs"),
        legs_step(),
        legs_on_plate_step(),
        struts_step(has_slotted_struts),
        sliders_step(),
        ends_step(),
        level_step(),
        step_without_stages("The first walk"),
        step_without_stages("A radio module, if you want one"),
        step_without_stages("A button and an obstacle switch, if you want them"),
    ]
}

fn chassis_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Printed | Kind::Screw(_) | Kind::Lead => 0.0,
        Kind::ServoScrew => 1.6,
        _ => 1.0,
    };
    let stage = robot_stage(|body| {
        let is_lower_screw =
            body.name.starts_with("screw standoff") && body.name.ends_with("below");
        let has_added_kind = matches!(
            body.kind,
            Kind::Servo | Kind::ServoScrew | Kind::Standoff(_) | Kind::Lead
        );
        body.name == "plate" || has_added_kind || is_lower_screw
    });
    build_step("Servos and standoffs", lift, ExtraView::Corner, vec![stage])
}

fn supply_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Battery => 1.0,
        Kind::Fitting(_) if body.name == "battery strap" => 0.0,
        _ => -0.7,
    };
    let stage = robot_stage(|body| {
        let names = ["battery", "ground strip", "supply strip", "capacitor"];
        has_name_prefix(body, &names)
    });
    let title = "Strips, battery and capacitor";
    build_step(title, lift, ExtraView::Below, vec![stage])
}

fn board_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Board => 1.3,
        Kind::Fitting(_) if has_name_prefix(body, &["converter", "alarm"]) => 0.3,
        Kind::Fitting(_) => 1.1,
        Kind::Screw(_) if body.name.contains("board") => 1.8,
        Kind::Screw(_) => 1.1,
        _ => 0.8,
    };
    let deck_stage = robot_stage(|body| {
        let is_upper_screw =
            body.name.starts_with("screw standoff") && body.name.ends_with("above");
        let names_on_deck = ["deck", "converter", "alarm"];
        let names_on_left_wing = ["signal strip", "resistor", "place for"];
        let names_on_right_wing = ["switch", "plus way", "fuse"];
        let names = [names_on_deck, names_on_left_wing, names_on_right_wing].concat();
        has_name_prefix(body, &names) || is_upper_screw
    });
    let board_stage = robot_stage(|body| has_name_prefix(body, &["board", "screw board"]));
    let stages = vec![deck_stage, board_stage];
    build_step("Deck, board and wires", lift, ExtraView::None, stages)
}

fn links_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Horn => 1.3,
        Kind::HornScrew(_) => 1.7,
        Kind::Printed => 0.8,
        _ => 0.3,
    };
    let stage = bench_stage(|body| {
        let is_horn = matches!(body.kind, Kind::Horn | Kind::HornScrew(_));
        is_horn || has_name_prefix(body, &["link", "screw tip", "screw arm"])
    });
    build_step("Horns and links", lift, ExtraView::Corner, vec![stage])
}

fn legs_step() -> Step {
    let lift = |body: &Body| match body.mount {
        Mount::Foot(_) if body.name.starts_with("screw foot") => 0.6,
        Mount::Foot(_) if body.name.starts_with("leg coupler") => 0.0,
        Mount::Foot(_) => -0.6,
        _ if body.name.starts_with("nut") && !body.name.contains("anchor") => 0.5,
        _ => 0.0,
    };
    let joints_stage = bench_stage(|body| {
        let names = ["leg coupler", "crank", "follower", "nut leg anchor"];
        let is_joint = ["crank joint", "follower joint"].map(|joint| body.name.contains(joint));
        has_name_prefix(body, &names) || is_joint.contains(&true)
    });
    let foot_stage = bench_stage(|body| matches!(body.mount, Mount::Foot(_)) && !sets_height(body));
    let height_stage = bench_stage(sets_height);
    let stages = vec![joints_stage, foot_stage, height_stage];
    build_step("Legs, on the bench", lift, ExtraView::Corner, stages)
}

/// True for a pad and for its screw, which sets the foot's height.
fn sets_height(body: &Body) -> bool {
    body.kind == Kind::Pad || has_name_prefix(body, &["screw height"])
}

fn level_step() -> Step {
    let stage = Stage {
        turns_again: |body| has_name_prefix(body, &["screw height"]),
        ..robot_stage(|_| false)
    };
    build_step("Level the feet", |_| 0.0, ExtraView::None, vec![stage])
}

fn legs_on_plate_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Nut => -0.7,
        _ => 1.0,
    };
    let stages = vec![robot_stage(|body| body.name.contains("pivot"))];
    build_step("Legs on the plate", lift, ExtraView::CornerBelow, stages)
}

fn struts_step(has_slotted_struts: bool) -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Screw(_) => 1.6,
        Kind::Nut => -0.4,
        Kind::Printed if body.name.starts_with("strut ring") => 0.5,
        _ => 0.3,
    };
    let leg_stage = robot_stage(|body| {
        matches!(body.mount, Mount::Strut(_)) || body.name.starts_with("screw leg anchor")
    });
    let link_stage =
        robot_stage(|body| has_name_prefix(body, &["strut ring", "screw anchor", "nut anchor"]));
    let title = match has_slotted_struts {
        true => "Struts and springs",
        false => "Struts",
    };
    build_step(title, lift, ExtraView::Corner, vec![leg_stage, link_stage])
}

fn sliders_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Nut => 1.4,
        Kind::Printed if body.name.starts_with("arm") => 0.3,
        _ => 0.8,
    };
    let stage = robot_stage(|body| {
        let is_slider = matches!(body.mount, Mount::Sleeve(_) | Mount::Rod(_));
        is_slider || has_name_prefix(body, &["arm spacer", "nut arm"])
    });
    build_step("Sliders", lift, ExtraView::None, vec![stage])
}

fn ends_step() -> Step {
    let lift = |body: &Body| match body.kind {
        Kind::Nut => 1.6,
        Kind::Screw(_) => 0.4,
        Kind::Printed if body.name.starts_with("tip") => 0.3,
        _ => 0.9,
    };
    let couplers_stage = bench_stage(|body| {
        let is_screw = has_name_prefix(body, &["screw head plate", "screw tail "]);
        is_screw || has_name_prefix(body, &["coupler", "head plate", "tail "])
    });
    let joints_stage = robot_stage(|body| {
        matches!(body.mount, Mount::Coupler(_)) || has_name_prefix(body, &["tip spacer", "nut tip"])
    });
    let plug_stage = robot_stage(|body| has_name_prefix(body, &["barrel plug"]));
    let stages = vec![couplers_stage, joints_stage, plug_stage];
    build_step("Head and tail", lift, ExtraView::None, stages)
}
