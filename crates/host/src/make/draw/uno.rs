//! A drawing of an Arduino UNO from above, with the pins at their real positions.

use svg::node::element::{Group, Text};

use crate::shared::shapes::{
    Anchor, DARK, GREY, PANEL_COLOUR, add_outline, circle, pin_name, rectangle, round_hundredths,
    text, text_middle, text_start,
};

/// Distance on the page between neighbouring pins, which are a tenth of an inch apart, pixels.
const PIN_PITCH: f64 = 14.0;

/// Width and height of the board, in tenths of an inch.
const BOARD_SIZE: (f64, f64) = (27.0, 21.0);

/// Height of the upper row of pins above the board's lower edge, in tenths of an inch.
const UPPER_ROW_Y: f64 = 20.0;
/// Height of the lower row of pins above the board's lower edge, in tenths of an inch.
const LOWER_ROW_Y: f64 = 1.0;

/// Distance of IOREF from the left edge, tenths of an inch; the other power pins are counted from IOREF.
const IOREF_X: f64 = 12.0;
/// The names printed beside the power pins, from IOREF on.
const POWER_PINS: [&str; 7] = ["IOREF", "RESET", "3.3V", "5V", "GND", "GND", "VIN"];
/// Distance of SCL from the left edge, tenths of an inch; SDA, AREF and GND are counted from SCL.
const SCL_X: f64 = 7.4;
/// The names printed beside the pins to the left of D13; AREF is the analogue reference.
const PINS_LEFT_OF_D13: [&str; 4] = ["SCL", "SDA", "AREF", "GND"];

/// Distance of D13 from the left edge, tenths of an inch; D12 to D8 are counted from D13.
const D13_X: f64 = 11.4;
/// Distance of D7 from the left edge, tenths of an inch; D6 to D0 are counted from D7.
const D7_X: f64 = 18.0;
/// Distance of A0 from the left edge, tenths of an inch; A1 to A5 are counted from A0.
const A0_X: f64 = 20.0;

/// An Arduino UNO at a position on a page.
#[derive(Clone, Copy, Debug)]
pub struct Uno {
    /// The board's upper left corner on the page, pixels.
    pub upper_left_corner: (f64, f64),
}

impl Uno {
    /// Returns the board's lower right corner.
    pub fn lower_right_corner(&self) -> (f64, f64) {
        self.to_page_point(BOARD_SIZE.0, 0.0)
    }

    /// Returns the position of the pin with Arduino number `number`, 0 to 19; 14 to 19 are A0 to A5.
    pub fn pin_point(&self, number: u8) -> (f64, f64) {
        let pin_number = f64::from(number);
        match number {
            0..=7 => self.to_page_point(D7_X + 7.0 - pin_number, UPPER_ROW_Y),
            8..=13 => self.to_page_point(D13_X + 13.0 - pin_number, UPPER_ROW_Y),
            _ => self.to_page_point(A0_X + pin_number - 14.0, LOWER_ROW_Y),
        }
    }

    /// Returns the position of the ground pin beside D13.
    pub fn ground_point(&self) -> (f64, f64) {
        self.to_page_point(D13_X - 1.0, UPPER_ROW_Y)
    }

    /// Returns the position of the 5V pin.
    pub fn five_volt_point(&self) -> (f64, f64) {
        self.to_page_point(IOREF_X + 3.0, LOWER_ROW_Y)
    }

    /// Draws the board and emphasizes the pins in `used_pins`.
    pub fn draw(&self, used_pins: &[u8]) -> Group {
        let size = (BOARD_SIZE.0 * PIN_PITCH, BOARD_SIZE.1 * PIN_PITCH);
        let board = rectangle(self.upper_left_corner, size, "#dfeaec").set("rx", 8);
        let group = Group::new().add(add_outline(board, DARK, 1.5));
        let mut group = self.draw_components(group);
        for number in 0..=19 {
            let (name, point) = (pin_name(number), self.pin_point(number));
            let is_used = used_pins.contains(&number);
            let hole = draw_hole(point, is_used).set("id", format!("pin-{name}"));
            group = group.add(hole).add(self.draw_label(point, &name, is_used));
        }
        for (index, name) in PINS_LEFT_OF_D13.into_iter().enumerate() {
            let point = self.to_page_point(SCL_X + index as f64, UPPER_ROW_Y);
            let is_used = point == self.ground_point();
            let mut hole = draw_hole(point, is_used);
            if is_used {
                hole = hole.set("id", "pin-GND");
            }
            group = group.add(hole).add(self.draw_label(point, name, is_used));
        }
        for (index, name) in POWER_PINS.into_iter().enumerate() {
            let point = self.to_page_point(IOREF_X + index as f64, LOWER_ROW_Y);
            group = group
                .add(draw_hole(point, false))
                .add(self.draw_label(point, name, false));
        }
        let name_point = self.to_page_point(9.0, 11.2);
        group.add(text_start("Arduino UNO", name_point, 18.0))
    }

    /// Adds the sockets, the chip and the LED to `group`.
    fn draw_components(&self, group: Group) -> Group {
        let draw_block = |x: f64, top: f64, size: (f64, f64), fill| {
            let size = (size.0 * PIN_PITCH, size.1 * PIN_PITCH);
            add_outline(rectangle(self.to_page_point(x, top), size, fill), DARK, 1.2)
        };
        let led = self.to_page_point(9.4, 13.6);
        group
            .add(draw_block(-2.5, 17.5, (6.4, 4.7), "#c9c9c9"))
            .add(text_middle("USB", self.to_page_point(0.7, 14.8), 14.0))
            .add(draw_block(-0.8, 4.8, (5.4, 3.6), "#bdbdbd"))
            .add(text_middle("7-12 V", self.to_page_point(1.9, 2.6), 13.0))
            .add(draw_block(11.5, 9.2, (13.0, 3.0), "#8f8f8f"))
            .add(circle(led, 4.5, "#f0e442").set("stroke", DARK))
            .add(text_start("LED", (led.0 + 9.0, led.1 + 5.0), 13.0))
    }

    /// Draws a pin's name beside the pin, rotated to read upwards.
    fn draw_label(&self, pin: (f64, f64), name: &str, is_used: bool) -> Text {
        let is_upper = pin.1 < self.upper_left_corner.1 + BOARD_SIZE.1 * PIN_PITCH / 2.0;
        let (y, anchor) = match is_upper {
            true => (pin.1 + 9.0, Anchor::End),
            false => (pin.1 - 9.0, Anchor::Start),
        };
        let x = pin.0 + 4.5;
        let colour = if is_used { DARK } else { GREY };
        let label = text(name, (x, y), 12.0, colour, anchor);
        let [x, y] = [x, y].map(round_hundredths);
        let label = label.set("transform", format!("rotate(-90 {x} {y})"));
        match is_used {
            true => label.set("font-weight", "bold"),
            false => label,
        }
    }

    /// Converts a position, in tenths of an inch right of and above the board's lower left corner, to a page position.
    fn to_page_point(self, right: f64, up: f64) -> (f64, f64) {
        let (x, y) = self.upper_left_corner;
        (x + right * PIN_PITCH, y + (BOARD_SIZE.1 - up) * PIN_PITCH)
    }
}

/// Draws a header's hole.
fn draw_hole(centre: (f64, f64), is_used: bool) -> svg::node::element::Circle {
    let fill = if is_used { DARK } else { PANEL_COLOUR };
    add_outline(circle(centre, 4.0, fill), DARK, 1.2)
}
