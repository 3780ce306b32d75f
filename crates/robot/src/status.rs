//! The robot's reports: the answer to `status`, and the poses that the robot sends after `watch`.

/// The name of the fault of a board without a usable robot in its flash.
const NO_ROBOT_FAULT: &str = "robot";

/// The reported state of a robot.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[cfg_attr(feature = "serde", serde(rename_all = "camelCase"))]
pub struct Status {
    /// The name of the current routine or, without one, of the gait, with hyphens for spaces; without either, `pose`,
    /// `stop` or `rest`.
    pub gait: String,
    /// Phase of the gait's cycle, 0 to 1; 0 while no gait runs.
    pub phase: f64,
    /// Servo angles, degrees, chassis frame; `None` if the flash contains no robot.
    pub pose: Option<[f64; 4]>,
    /// Pace of the gaits, percent, `speed` in the answer; `None` if the flash contains no robot.
    pub pace: Option<f64>,
    /// Number of frames since the program started.
    pub frames: u64,
    /// The smallest of the guard's margins, the sine of an angle; `None` if the flash contains no robot.
    pub margin: Option<f64>,
    /// True if the guard holds the robot in its last safe pose.
    pub is_held: bool,
    /// The fault's name; `None` if there is no fault.
    pub fault: Option<String>,
    /// Supply voltage of the board, V; `None` until it is measured.
    pub vcc: Option<f64>,
    /// Supply voltage of the servos, V; `None` if it is not measured.
    pub rail: Option<f64>,
    /// Number of late pulse edges.
    pub late_edges: u32,
    /// Number of bytes lost on reception.
    pub lost_bytes: u32,
    /// Cause of the last reset.
    pub reset_cause: String,
    /// Number of resets since power-on.
    pub reset_count: u32,
}

impl Status {
    /// Parses the answer `ok gait=...`; `None` for any other line. Skips unknown keys.
    #[must_use]
    pub fn parse(answer: &str) -> Option<Self> {
        let pairs = answer.strip_prefix("ok ")?;
        let find_value = |key: &str| {
            let mut pairs = pairs.split(' ').filter_map(|pair| pair.split_once('='));
            pairs.find_map(|(name, value)| (name == key).then_some(value))
        };
        let find_number = |key: &str| find_value(key)?.parse().ok();
        let find_count = |key: &str| find_value(key).and_then(|n| n.parse().ok()).unwrap_or(0);
        let pose = find_value("pose").and_then(parse_angles);
        let margin = find_number("margin");
        let has_pose_and_margin = pose.is_some() && margin.is_some();
        if !has_pose_and_margin && find_value("fault") != Some(NO_ROBOT_FAULT) {
            return None;
        }
        Some(Self {
            gait: find_value("gait")?.to_owned(),
            phase: find_number("phase").unwrap_or(0.0),
            pose,
            pace: find_number("speed"),
            frames: find_value("frames")
                .and_then(|n| n.parse().ok())
                .unwrap_or(0),
            margin,
            is_held: find_value("guard") == Some("held"),
            fault: find_value("fault")
                .filter(|name| *name != "none")
                .map(str::to_owned),
            vcc: find_number("vcc"),
            rail: find_number("rail"),
            late_edges: find_count("late"),
            lost_bytes: find_count("rx_lost"),
            reset_cause: find_value("reset").unwrap_or_default().to_owned(),
            reset_count: find_count("resets"),
        })
    }

    /// True if a gait or a routine runs, so that the robot keeps moving without further commands.
    #[must_use]
    pub fn is_walking(&self) -> bool {
        !matches!(self.gait.as_str(), "stand" | "pose" | "stop" | "rest")
    }

    /// Formats the state as one line for a terminal.
    #[must_use]
    pub fn format_line(&self) -> String {
        let mut line = self.gait.clone();
        if let Some([a1, a2, a3, a4]) = self.pose {
            line += &format!("  A1..A4 {a1:.1} {a2:.1} {a3:.1} {a4:.1}");
        }
        if let Some(margin) = self.margin {
            line += &format!("  margin {margin:.2}");
        }
        if let Some(vcc) = self.vcc {
            line += &format!("  {vcc:.2} V");
        }
        if let Some(rail) = self.rail {
            line += &format!("  servos {rail:.2} V");
        }
        match (&self.fault, self.is_held) {
            (Some(fault), _) => line += &format!("  FAULT {fault}"),
            (None, true) => line += "  HELD by the guard",
            (None, false) => line += "  no fault",
        }
        for (count, name) in [
            (self.late_edges, "late edges"),
            (self.lost_bytes, "bytes lost"),
        ] {
            if count > 0 {
                line += &format!("  {count} {name}");
            }
        }
        line
    }
}

/// Parses a line `# t=<frame> pose=<angles>` into the frame and the servo angles, degrees; `None` for any other line.
#[must_use]
pub fn parse_pose_report(line: &str) -> Option<(u64, [f64; 4])> {
    let (frame, pose) = line.strip_prefix("# t=")?.split_once(" pose=")?;
    Some((frame.parse().ok()?, parse_angles(pose)?))
}

/// Parses four angles, separated by commas; `None` for any other text.
fn parse_angles(text: &str) -> Option<[f64; 4]> {
    let angles: Option<Vec<f64>> = text.split(',').map(|angle| angle.parse().ok()).collect();
    let angles: [f64; 4] = angles?.try_into().ok()?;
    let are_finite = angles.iter().all(|angle| angle.is_finite());
    are_finite.then_some(angles)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The answer of a robot that walks without a fault.
    const WALKING_STATUS: &str = "ok gait=arc-left phase=0.350 pose=138.59,41.41,318.60,221.40 \
        margin=0.812 speed=100 frames=1234 late=3 rx_lost=2 guard=clear fault=none \
        reset=external resets=3 vcc=5.02 rail=5.91";

    #[test]
    fn a_status_is_parsed_and_formatted_in_one_line() {
        let status = Status::parse(WALKING_STATUS).expect("the line is a status");
        assert!(status.is_walking());
        assert_eq!((status.phase, status.pace), (0.35, Some(100.0)));
        assert_eq!(status.reset_cause, "external");
        assert_eq!(status.reset_count, 3);
        let expected = "arc-left  A1..A4 138.6 41.4 318.6 221.4  margin 0.81  5.02 V  servos 5.91 V  \
             no fault  3 late edges  2 bytes lost";
        assert_eq!(status.format_line(), expected);
    }

    #[test]
    fn faults_and_holds_by_the_guard_are_marked_in_capitals() {
        for (old, new, phrase) in [
            ("fault=none", "fault=supply", "FAULT supply"),
            ("clear", "held", "HELD by the guard"),
        ] {
            let status = Status::parse(&WALKING_STATUS.replace(old, new));
            let line = status.expect("the line is a status").format_line();
            assert!(line.contains(phrase), "{line}");
        }
    }

    #[test]
    fn a_board_without_a_robot_has_no_pose_and_shows_its_fault() {
        let line = "ok gait=rest late=0 rx_lost=0 guard=clear fault=robot reset=power resets=0";
        let status = Status::parse(line).expect("the line is a status");
        assert_eq!((status.pose, status.margin, status.vcc), (None, None, None));
        assert_eq!(status.format_line(), "rest  FAULT robot");
    }

    #[test]
    fn a_reported_pose_has_four_angles() {
        let report = parse_pose_report("# t=7 pose=1.00,2.00,3.00,4.50");
        assert_eq!(report, Some((7, [1.0, 2.0, 3.0, 4.5])));
        for line in [
            "# t=7 pose=1,2,3",
            "# t=7 pose=1,2,3,nan",
            "# t= pose=1,2,3,4",
            "t=7 pose=1,2,3,4",
        ] {
            assert_eq!(parse_pose_report(line), None, "{line}");
        }
    }

    #[test]
    fn other_lines_are_not_a_status() {
        for line in [
            "ok walk",
            "err 1 no",
            "ok gait=walk",
            "ok gait=a pose=1,2,3 margin=1",
        ] {
            assert_eq!(Status::parse(line), None, "{line}");
        }
    }
}
