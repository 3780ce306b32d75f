//! Films whose truth is known, rendered with all that spoils a picture.

mod accuracy;
mod cameras;
mod render;
mod several;
mod studio;
mod troubles;
mod walk;
