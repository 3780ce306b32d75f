//! Tests of the sheet's PDF: the page is rasterised, and the tag detector reads it.

use std::fs;

use lizard_video::{Frame, read_tags, sheet};

use crate::harness::{assert_contains, run_line_in, scratch_folder};

/// Resolution of the rasterised page, pixels per mm.
const PIXELS_PER_MM: f64 = 3.0;
/// Size of a PDF point, mm.
const MM_PER_POINT: f64 = 25.4 / 72.0;

/// Returns the operands of each line in `text` that ends in the PDF operator `operator`.
fn parse_operands(text: &str, operator: &str) -> Vec<Vec<f64>> {
    let lines = text.lines();
    let operand_lists = lines.filter_map(|line| line.strip_suffix(operator));
    let words = operand_lists.map(str::split_whitespace);
    let operands = words.map(|words| words.filter_map(|word| word.parse().ok()).collect());
    operands.collect()
}

/// Writes the sheet; returns the PDF's text, and the page's width and height in mm.
fn write_sheet(paper: &str) -> (String, [f64; 2]) {
    let name = format!("sheets/{paper}.pdf");
    let line = format!("measure sheet --paper {paper} --output {name}");
    let output = run_line_in(scratch_folder(), &line).expect_success();
    assert_contains(&output, "print it at 100 %");
    let bytes = fs::read(scratch_folder().join(name)).expect("the file is readable");
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let media_box = text.split_once("/MediaBox [");
    let (_, media_box) = media_box.expect("the PDF has a page size");
    let (media_box, _) = media_box.split_once(']').expect("the page size ends");
    let words: Vec<&str> = media_box.split(' ').collect();
    let parse = |word: &str| word.parse::<f64>().expect("the value is a number");
    let size = [2, 3].map(|i| parse(words[i]) * MM_PER_POINT);
    (text, size)
}

/// Draws the filled rectangles of a page into a frame. Also returns the extent of the ink: the smallest and largest
/// distances from the left edge, then from the lower edge, mm.
fn rasterize(text: &str, [page_width, page_height]: [f64; 2]) -> (Frame, [[f64; 2]; 2]) {
    let columns = (page_width * PIXELS_PER_MM) as usize;
    let rows = (page_height * PIXELS_PER_MM) as usize;
    let mut pixels = vec![255; columns * rows];
    let mut ink_extent = [[f64::INFINITY, f64::NEG_INFINITY]; 2];
    let mut lines = text.lines().peekable();
    let mut fill = 0;
    while let Some(line) = lines.next() {
        if let Some(operands) = parse_operands(line, " g").pop() {
            fill = (255.0 * operands[0]) as u8;
        }
        let Some(rectangle) = parse_operands(line, " re").pop() else {
            continue;
        };
        let [x, y, width, height] = [0, 1, 2, 3].map(|i| rectangle[i] * MM_PER_POINT);
        for (axis, (start, length)) in [(x, width), (y, height)].into_iter().enumerate() {
            let [min, max] = ink_extent[axis];
            ink_extent[axis] = [min.min(start), max.max(start + length)];
        }
        if lines.peek() != Some(&"f") {
            continue;
        }
        // A pixel is filled if its centre is in the rectangle.
        let pixel_range = |start: f64, end: f64| {
            (start * PIXELS_PER_MM + 0.5) as usize..(end * PIXELS_PER_MM + 0.5) as usize
        };
        for row in pixel_range(page_height - y - height, page_height - y) {
            for column in pixel_range(x, x + width) {
                pixels[row * columns + column] = fill;
            }
        }
    }
    let frame = Frame::new(columns, rows, pixels).expect("the page has pixels");
    (frame, ink_extent)
}

#[test]
fn a_printed_sheet_shows_all_tags_at_actual_size() {
    for (paper, paper_mm) in [("a4", [297.0_f64, 210.0]), ("letter", [279.4, 215.9])] {
        let (text, page_mm) = write_sheet(paper);
        let (frame, ink_extent) = rasterize(&text, page_mm);
        for (axis, [min, max]) in ink_extent.into_iter().enumerate() {
            assert!((page_mm[axis] - paper_mm[axis]).abs() < 0.1, "{page_mm:?}");
            let is_printable = min > 5.0 && max < page_mm[axis] - 5.0;
            assert!(
                is_printable,
                "ink outside the printable area: {ink_extent:?}"
            );
        }
        let mut tags = read_tags(&frame);
        tags.sort_by_key(|tag| tag.id);
        let ids: Vec<usize> = tags.iter().map(|tag| tag.id).collect();
        assert_eq!(ids, [0, 1, 2, 3, 4], "{paper}");
        let distance_mm =
            |a: [f64; 2], b: [f64; 2]| (a[0] - b[0]).hypot(a[1] - b[1]) / PIXELS_PER_MM;
        for tag in &tags {
            let [left, right, ..] = tag.corners;
            let edge_mm = distance_mm(left, right);
            let id = tag.id;
            let error_mm = edge_mm - sheet::tag_edge(id);
            assert!(error_mm.abs() < 0.4, "{paper}, tag {id}: {edge_mm} mm");
            let is_upright = left[0] < right[0] && (left[1] - right[1]).abs() < 1.0;
            assert!(is_upright, "{paper}, tag {id}");
        }
        for first in [0, 2] {
            let spacing_mm = distance_mm(tags[first].corners[0], tags[first + 1].corners[0]);
            let error_mm = spacing_mm - sheet::TAG_SPACING;
            assert!(error_mm.abs() < 0.4, "{paper}: {spacing_mm} mm");
        }
    }
}

#[test]
fn the_ruler_line_of_a_strip_is_100_mm_long() {
    let (text, _) = write_sheet("a4");
    let rectangles = parse_operands(&text, " re").into_iter();
    let rectangles = rectangles.map(|operands| [0, 1, 2, 3].map(|i| operands[i] * MM_PER_POINT));
    let is_ruler = |rectangle: &[f64; 4]| (rectangle[2] - sheet::RULER_LENGTH).abs() < 0.01;
    let ruler_count = rectangles.clone().filter(is_ruler).count();
    assert_eq!(ruler_count, sheet::STRIP_COUNT);
    // The outer edges of the two 8 mm end ticks are at the ends of the line.
    let ticks = rectangles.filter(|rectangle| (rectangle[3] - 8.0).abs() < 0.01);
    let ticks: Vec<[f64; 2]> = ticks.map(|[x, _, width, _]| [x, x + width]).collect();
    assert_eq!(ticks.len(), 2 * sheet::STRIP_COUNT);
    let distance = ticks[1][1] - ticks[0][0];
    assert!((distance - sheet::RULER_LENGTH).abs() < 0.01, "{ticks:?}");
}
