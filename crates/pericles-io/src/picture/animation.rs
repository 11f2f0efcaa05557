//! Animated PNG, which browsers and most viewers play; other readers show its first picture.

use std::fs::File;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};

use super::bitmap::{COMPRESSION, encoding};
use crate::{IoError, write_atomically};

/// Frames per second.
const RATE: u16 = 10;

/// A picture as read from a file.
struct Still {
    width: usize,
    height: usize,
    rgb: Vec<u8>,
}

impl Still {
    fn read(path: &Path) -> Result<Self, IoError> {
        let damaged = |reason: String| IoError::Damaged {
            path: path.to_path_buf(),
            reason,
        };
        let file = File::open(path).map_err(|error| damaged(error.to_string()))?;
        let mut reader = png::Decoder::new(BufReader::new(file))
            .read_info()
            .map_err(|error| damaged(error.to_string()))?;
        let info = reader.info();
        if (info.color_type, info.bit_depth) != (png::ColorType::Rgb, png::BitDepth::Eight) {
            return Err(damaged(
                "it is not an 8-bit RGB picture, the format that Pericles writes".into(),
            ));
        }
        let (width, height) = (info.width as usize, info.height as usize);
        let mut rgb = vec![0; 3 * width * height];
        reader
            .next_frame(&mut rgb)
            .map_err(|error| damaged(error.to_string()))?;
        Ok(Self { width, height, rgb })
    }

    /// Returns the picture at the upper left of white paper of another size.
    fn on(&self, [width, height]: [usize; 2]) -> Vec<u8> {
        let mut paper = vec![255; 3 * width * height];
        for (row, old) in paper
            .chunks_mut(3 * width)
            .zip(self.rgb.chunks(3 * self.width))
        {
            row[..old.len()].copy_from_slice(old);
        }
        paper
    }
}

/// Combines pictures written by Pericles into one looping animation with ten frames per second. Its size is
/// that of the largest picture.
///
/// The files are read twice, with one picture in memory at a time; the animation is written atomically.
///
/// # Errors
/// Returns an error for no pictures, a file that is not a picture of Pericles, or a file that cannot be written.
pub fn write_animation(stills: &[PathBuf], path: impl AsRef<Path>) -> Result<(), IoError> {
    let path = path.as_ref();
    let mut size = [0, 0];
    for still in stills {
        let still = Still::read(still)?;
        size = [size[0].max(still.width), size[1].max(still.height)];
    }
    if stills.is_empty() {
        return Err(IoError::Unsuitable {
            path: path.to_path_buf(),
            reason: "an animation needs at least one picture".into(),
        });
    }
    write_atomically(path, |out| {
        let mut encoder = png::Encoder::new(out, size[0] as u32, size[1] as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_deflate_compression(COMPRESSION);
        encoder
            .set_animated(stills.len() as u32, 0)
            .map_err(encoding)?;
        encoder.set_frame_delay(1, RATE).map_err(encoding)?;
        let mut writer = encoder.write_header().map_err(encoding)?;
        for still in stills {
            let still = Still::read(still).map_err(io::Error::other)?;
            writer.write_image_data(&still.on(size)).map_err(encoding)?;
        }
        writer.finish().map_err(encoding)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::picture::bitmap::Bitmap;

    #[test]
    fn all_frames_are_read_back_in_order() {
        let folder = tempfile::tempdir().unwrap();
        let stills: Vec<PathBuf> = [(31, 17), (20, 25), (31, 17)]
            .iter()
            .enumerate()
            .map(|(k, &(width, height))| {
                let path = folder.path().join(format!("{k}.png"));
                let mut bitmap = Bitmap::white(width, height);
                let at = 3.0 * k as f64;
                let colour = [200, 10, 60 * k as u8];
                bitmap.fill_rectangle((at, 4.0), (at + 3.0, 9.0), colour, 1.0);
                bitmap.write_png(&path).unwrap();
                path
            })
            .collect();
        let path = folder.path().join("moving.apng");
        write_animation(&stills, &path).unwrap();
        let decoder = png::Decoder::new(BufReader::new(File::open(&path).unwrap()));
        let mut reader = decoder.read_info().unwrap();
        let control = *reader.info().animation_control().unwrap();
        assert_eq!((control.num_frames, control.num_plays), (3, 0));
        for still in &stills {
            let mut rgb = vec![0; 3 * 31 * 25];
            reader.next_frame(&mut rgb).unwrap();
            let frame = reader.info().frame_control().unwrap();
            assert_eq!((frame.delay_num, frame.delay_den), (1, RATE));
            assert_eq!(rgb, Still::read(still).unwrap().on([31, 25]));
        }
        assert!(reader.next_frame(&mut vec![0; 3 * 31 * 25]).is_err());
    }

    #[test]
    fn files_that_are_not_pictures_are_rejected() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("moving.apng");
        let none = write_animation(&[], &path);
        assert!(matches!(none, Err(IoError::Unsuitable { .. })), "{none:?}");
        let text = folder.path().join("text.png");
        std::fs::write(&text, "no picture").unwrap();
        for wrong in [text, folder.path().join("missing.png")] {
            let found = write_animation(&[wrong], &path);
            assert!(matches!(found, Err(IoError::Damaged { .. })), "{found:?}");
        }
        assert!(!path.exists());
    }
}
