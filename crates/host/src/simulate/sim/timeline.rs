//! The picture of a run: the servo angles over time, and each foot's stance and swing.

use lizard_robot::servo::SERVO_NAMES;
use svg::node::element::Group;

use super::analysis::Run;
use super::footfall::{Phase, list_foot_spans};
use super::spans::Span;
use crate::shared::shapes::{
    Anchor, DARK, GREY, GRID_COLOUR, PANEL_COLOUR, SERVO_COLOURS, SERVO_POSITIONS, add_outline,
    add_title, curve, line, pin_name, rectangle, render_svg, text, text_middle, text_start,
};

/// Width of the picture, px.
const WIDTH: f64 = 1280.0;
/// Width of the left margin, px.
const LEFT_MARGIN: f64 = 200.0;
/// Width of the right margin, px.
const RIGHT_MARGIN: f64 = 36.0;
/// Width of the strips, px.
const STRIP_WIDTH: f64 = WIDTH - LEFT_MARGIN - RIGHT_MARGIN;
/// Horizontal middle of the strips, px.
const MIDDLE_X: f64 = LEFT_MARGIN + STRIP_WIDTH / 2.0;
/// Upper edge of the band with the commands, px.
const COMMANDS_Y: f64 = 88.0;
/// Upper edge of the first servo's strip, px.
const STRIPS_Y: f64 = 132.0;
/// Height of a servo's strip, px.
const STRIP_HEIGHT: f64 = 104.0;
/// Gap between two strips, px.
const STRIP_GAP: f64 = 14.0;
/// Upper edge of the first row of footfalls, px.
const FEET_Y: f64 = STRIPS_Y + 4.0 * (STRIP_HEIGHT + STRIP_GAP) + 34.0;
/// Height of a row of footfalls, px.
const FOOT_HEIGHT: f64 = 28.0;
/// Gap between two rows of footfalls, px.
const FOOT_GAP: f64 = 8.0;
/// Vertical position of the time axis, px.
const AXIS_Y: f64 = FEET_Y + 4.0 * (FOOT_HEIGHT + FOOT_GAP) + 4.0;
/// Height of the picture, px.
const HEIGHT: f64 = AXIS_Y + 96.0;

/// The title and description of the picture.
#[derive(Debug, Clone, Copy)]
pub struct Caption {
    /// Title above the picture, in large type.
    pub title: &'static str,
    /// Description below the title, in small type.
    pub note: &'static str,
    /// Label below the time axis, with its unit.
    pub axis_label: &'static str,
}

/// The caption of a run on the simulated UNO.
pub const SIMULATED_CAPTION: Caption = Caption {
    title: "Servo angles and footfalls, measured on the simulated UNO",
    note: "degrees in the chassis frame, read back from every pulse; dashed: the neutral angle",
    axis_label: "time since power-on (s)",
};

/// Draws the picture and returns it as SVG text. `spans` are the commands in effect.
pub fn draw(run: Run<'_>, spans: &[Span], caption: &Caption) -> String {
    let end_s = spans.last().map_or(0.0, |span| span.end_s);
    let chart = Chart {
        run,
        spans,
        caption,
        end_s: end_s.max(0.1),
    };
    let half_range_deg = chart.compute_half_range_deg();
    let mut group = add_title(Group::new(), LEFT_MARGIN, caption.title, caption.note);
    group = chart.draw_commands(group);
    for servo in 0..4 {
        group = chart.draw_strip(group, servo, half_range_deg);
        group = chart.draw_foot_row(group, servo);
    }
    group = chart.draw_command_changes(group);
    group = chart.draw_axis(group);
    render_svg((WIDTH, HEIGHT), group)
}

/// The contents of a picture.
struct Chart<'a> {
    run: Run<'a>,
    spans: &'a [Span],
    caption: &'a Caption,
    /// End of the time axis, s; it starts at 0.
    end_s: f64,
}

impl Chart<'_> {
    /// Returns the horizontal position of a time, px.
    fn to_x(&self, seconds: f64) -> f64 {
        LEFT_MARGIN + STRIP_WIDTH * seconds / self.end_s
    }

    /// Adds the band with the commands in effect.
    fn draw_commands(&self, mut group: Group) -> Group {
        for (index, span) in self.spans.iter().enumerate() {
            let (x, end_x) = (self.to_x(span.start_s), self.to_x(span.end_s));
            let fill = if index % 2 == 0 { "#e6e6e6" } else { "#d2d2d2" };
            group = group.add(rectangle((x, COMMANDS_Y), (end_x - x, 26.0), fill));
            // A letter takes about 7.5 px. A command that does not fit is omitted.
            if span.command.len() as f64 * 7.5 < end_x - x {
                let position = ((x + end_x) / 2.0, COMMANDS_Y + 18.0);
                group = group.add(text_middle(&span.command, position, 15.0));
            }
        }
        let position = (LEFT_MARGIN - 12.0, COMMANDS_Y + 18.0);
        group.add(text("command", position, 15.0, GREY, Anchor::End))
    }

    /// Adds a vertical line across the complete picture at each change of command.
    fn draw_command_changes(&self, mut group: Group) -> Group {
        for span in self.spans.iter().skip(1) {
            let x = self.to_x(span.start_s);
            let mark = line((x, COMMANDS_Y), (x, AXIS_Y), GREY, 1.0);
            group = group.add(mark.set("stroke-dasharray", "2 4"));
        }
        group
    }

    /// Computes half a strip's angle range, deg; all strips have the same range, so that their slopes can be compared.
    fn compute_half_range_deg(&self) -> f64 {
        let sweeps = self.run.servo_frames().filter_map(|frame| frame.sweeps);
        let max_sweep = sweeps.flatten().map(f64::abs).fold(20.0, f64::max);
        (max_sweep / 10.0).ceil() * 10.0 + 5.0
    }

    /// Adds the strip with a servo's angle over time.
    fn draw_strip(&self, mut group: Group, servo: usize, half_range_deg: f64) -> Group {
        let top = STRIPS_Y + servo as f64 * (STRIP_HEIGHT + STRIP_GAP);
        let neutral = self.run.robot.servos()[servo].neutral;
        let to_y =
            |angle: f64| top + STRIP_HEIGHT / 2.0 * (1.0 - (angle - neutral) / half_range_deg);
        let (start_x, end_x) = (LEFT_MARGIN, LEFT_MARGIN + STRIP_WIDTH);
        let name = format!("{} {}", SERVO_NAMES[servo], SERVO_POSITIONS[servo]);
        let pin = pin_name(self.run.robot.servos()[servo].pin);
        let middle_y = top + STRIP_HEIGHT / 2.0;
        let colour = SERVO_COLOURS[servo];
        let size = (STRIP_WIDTH, STRIP_HEIGHT);
        let name_text = text(&name, (14.0, middle_y - 2.0), 17.0, colour, Anchor::Start);
        let pin_text = text(&pin, (14.0, middle_y + 18.0), 14.0, GREY, Anchor::Start);
        group = group
            .add(rectangle((start_x, top), size, PANEL_COLOUR))
            .add(name_text.set("font-weight", "bold"))
            .add(pin_text);
        let tick_interval_deg = if half_range_deg > 50.0 { 40.0 } else { 20.0 };
        let first_tick = -(half_range_deg / tick_interval_deg).floor() as i32;
        for tick in first_tick..=-first_tick {
            let angle = neutral + f64::from(tick) * tick_interval_deg;
            let y = to_y(angle);
            let draw_line = |colour: &str| line((start_x, y), (end_x, y), colour, 1.0);
            group = group.add(match tick {
                0 => draw_line("#999999").set("stroke-dasharray", "6 4"),
                _ => draw_line(GRID_COLOUR),
            });
            let label = format!("{angle:.0}°");
            let position = (LEFT_MARGIN - 8.0, y + 4.5);
            group = group.add(text(&label, position, 13.0, GREY, Anchor::End));
        }
        for angle_curve in self.compute_angle_curves(servo) {
            let to_point = |(seconds, angle)| (self.to_x(seconds), to_y(angle));
            let points: Vec<_> = angle_curve.into_iter().map(to_point).collect();
            group = group.add(curve(&points, colour, 2.2));
        }
        group
    }

    /// Returns a servo's angle as points (seconds, degrees), with one curve for each time span with pulses. If there
    /// are many frames per pixel column, only the lowest and the highest angle in each column are kept.
    fn compute_angle_curves(&self, servo: usize) -> Vec<Vec<(f64, f64)>> {
        let is_dense = self.run.log.widths.len() as f64 > 4.0 * STRIP_WIDTH;
        let mut curves = vec![Curve::default()];
        for servo_frame in self.run.servo_frames() {
            match (servo_frame.angles, curves.last_mut()) {
                (Some(angles), Some(last_curve)) => {
                    let column = is_dense.then(|| self.to_x(servo_frame.seconds) as i64);
                    last_curve.add_point(column, (servo_frame.seconds, angles[servo]));
                }
                (None, Some(last_curve)) if last_curve.points.is_empty() => {}
                _ => curves.push(Curve::default()),
            }
        }
        let curves = curves.into_iter().map(|curve| curve.points);
        curves.filter(|points| !points.is_empty()).collect()
    }

    /// Adds the row with the footfalls of a servo's foot; the first row also gets the heading and the legend.
    fn draw_foot_row(&self, mut group: Group, servo: usize) -> Group {
        let top = FEET_Y + servo as f64 * (FOOT_HEIGHT + FOOT_GAP);
        if servo == 0 {
            let position = (14.0, FEET_Y - 12.0);
            group = group.add(text_start("Footfalls", position, 17.0).set("font-weight", "bold"));
            group = self.draw_legend(group);
        }
        let text_y = top + FOOT_HEIGHT / 2.0 + 5.0;
        let (name, colour) = (SERVO_POSITIONS[servo], SERVO_COLOURS[servo]);
        let name_point = (LEFT_MARGIN - 12.0, text_y);
        let name_text = text(name, name_point, 15.0, colour, Anchor::End);
        let size = (STRIP_WIDTH, FOOT_HEIGHT);
        group = group
            .add(rectangle((LEFT_MARGIN, top), size, PANEL_COLOUR))
            .add(name_text);
        let foot_spans = list_foot_spans(self.run.servo_frames(), servo);
        if foot_spans.len() as f64 > STRIP_WIDTH / 2.0 {
            let position = (MIDDLE_X, text_y);
            let note = "the steps are too narrow to be drawn; simulate a shorter time to see them";
            return group.add(text(note, position, 13.0, GREY, Anchor::Middle));
        }
        for span in foot_spans {
            let (x, end_x) = (self.to_x(span.start_s), self.to_x(span.end_s));
            let size = (end_x - x, FOOT_HEIGHT);
            group = group.add(foot_span_rectangle(span.phase, colour, (x, top), size));
        }
        group
    }

    /// Adds the legend of the footfalls.
    fn draw_legend(&self, mut group: Group) -> Group {
        let entries = [
            (Phase::Stance, "moves back: stance of a forward gait"),
            (Phase::Still, "stands still"),
            (Phase::Swing, "moves forward: return"),
        ];
        let mut x = LEFT_MARGIN;
        for (phase, label) in entries {
            let corner = (x, FEET_Y - 25.0);
            let label_text = text(label, (x + 38.0, FEET_Y - 12.5), 14.0, GREY, Anchor::Start);
            group = group
                .add(foot_span_rectangle(phase, "#444444", corner, (30.0, 15.0)))
                .add(label_text);
            x += 60.0 + 7.2 * label.len() as f64;
        }
        group
    }

    /// Adds the time axis.
    fn draw_axis(&self, mut group: Group) -> Group {
        let tick_intervals = [
            0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0, 300.0, 600.0, 1800.0, 3600.0,
        ];
        let tick_interval_s = tick_intervals
            .into_iter()
            .find(|tick_interval_s| self.end_s / tick_interval_s <= 15.0)
            .unwrap_or(7200.0);
        let end_x = LEFT_MARGIN + STRIP_WIDTH;
        group = group.add(line((LEFT_MARGIN, AXIS_Y), (end_x, AXIS_Y), DARK, 1.2));
        for tick in 0..=(self.end_s / tick_interval_s + 1e-9) as u32 {
            let seconds = f64::from(tick) * tick_interval_s;
            let x = self.to_x(seconds);
            let decimals = if tick_interval_s < 1.0 { 1 } else { 0 };
            let label = format!("{seconds:.decimals$}");
            group = group
                .add(line((x, AXIS_Y), (x, AXIS_Y + 7.0), DARK, 1.2))
                .add(text_middle(&label, (x, AXIS_Y + 25.0), 14.0));
        }
        let label_point = (MIDDLE_X, AXIS_Y + 50.0);
        group.add(text_middle(self.caption.axis_label, label_point, 15.0))
    }
}

/// Returns a time span of a footfall row as a rectangle: filled for stance, pale for still, outlined for swing, so that
/// the picture is readable without colour. `corner` is the upper left corner.
fn foot_span_rectangle(
    phase: Phase,
    colour: &str,
    corner: (f64, f64),
    size: (f64, f64),
) -> svg::node::element::Rectangle {
    match phase {
        Phase::Stance => rectangle(corner, size, colour),
        Phase::Still => rectangle(corner, size, colour).set("fill-opacity", 0.22),
        Phase::Swing => {
            // The outline stays inside the area of the time span.
            let inner_corner = (corner.0 + 0.7, corner.1 + 0.7);
            let inner_size = ((size.0 - 1.4).max(0.2), size.1 - 1.4);
            add_outline(rectangle(inner_corner, inner_size, "white"), colour, 1.4)
        }
    }
}

/// A curve under construction.
#[derive(Default)]
struct Curve {
    points: Vec<(f64, f64)>,
    /// Pixel column of the last point.
    column: Option<i64>,
}

impl Curve {
    /// Adds a point in a pixel column. Only the lowest and the highest point in a column are kept. If `column` is
    /// `None`, all points are kept.
    fn add_point(&mut self, column: Option<i64>, point: (f64, f64)) {
        if column.is_none() {
            self.points.push(point);
        } else if column != self.column {
            self.column = column;
            self.points.extend([point, point]);
        } else if let [.., min, max] = self.points.as_mut_slice() {
            // Both points of a column are the same at first, so the first of them stays the lowest.
            if point.1 < min.1 {
                *min = point;
            } else if point.1 > max.1 {
                *max = point;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::simulate::sim::frame_log::FrameLog;

    fn draw_picture(
        frame_count: usize,
        pulse_width: impl Fn(usize) -> u16,
        spans: &[Span],
    ) -> String {
        let robot = crate::shared::robot_args::built_in_robot("paper");
        let widths = (0..frame_count).map(|index| [pulse_width(index); 4]);
        let log = FrameLog::new(0, widths.collect());
        draw(Run::new(&robot, &log), spans, &SIMULATED_CAPTION)
    }

    #[test]
    fn each_time_span_with_pulses_is_one_curve_per_servo() {
        let is_resting = |n| n == 100 || n >= 350;
        let pulse_width = |n| if is_resting(n) { 0 } else { 24_000 };
        let spans = [Span::new("stand", 0.0, 1.0), Span::new("walk", 1.0, 8.0)];
        let picture = draw_picture(400, pulse_width, &spans);
        assert_eq!(picture.matches("<polyline").count(), 8);
        assert!(picture.contains("walk"));
    }

    #[test]
    fn a_picture_of_a_long_run_is_small_and_keeps_the_extremes() {
        // One frame out of 10 000 is an extreme.
        let pulse_width = |n| match n {
            5000 => 24_800,
            _ => 24_000 + 10 * (n as u16 % 3),
        };
        let picture = draw_picture(10_000, pulse_width, &[Span::new("stand", 0.0, 200.0)]);
        assert!(picture.len() < 300_000, "{} bytes", picture.len());
        // 50 us are 5 degrees or 10.4 pixels: half a strip has 52 pixels for 25 degrees.
        let first_curve = picture.split("points=\"").nth(1);
        let points = first_curve.and_then(|curve| curve.split('"').next());
        let points = points.expect("the picture has a curve").split_whitespace();
        let ys = points.filter_map(|point| point.split_once(',')?.1.parse::<f64>().ok());
        let [min, max] = ys.fold([f64::MAX, f64::MIN], |[min, max], y| {
            [min.min(y), max.max(y)]
        });
        assert!((max - min - 10.4).abs() < 0.2, "{min} to {max}");
    }
}
