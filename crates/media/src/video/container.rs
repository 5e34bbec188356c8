//! The MP4 file (ISO/IEC 14496-12 and -15): pictures as they come, then the index.

use crate::MediaError;
use crate::files::WholeFile;
use std::io::{Seek, SeekFrom, Write};
use std::path::Path;

/// Writes the pictures' bytes first and the index of them last.
pub(super) struct Mp4Writer {
    file: WholeFile,
    width: usize,
    height: usize,
    /// Units of time a second, and of each picture.
    time_scale: u32,
    duration: u32,
    /// Bytes of each picture.
    sizes: Vec<u32>,
    /// Numbers of the pictures that stand alone, from 1.
    keys: Vec<u32>,
    /// Where the data begins, and its bytes so far.
    data_start: u64,
    data_bytes: u64,
}

/// A box: its length, its name, its content.
fn boxed(name: &[u8; 4], content: &[&[u8]]) -> Vec<u8> {
    let length = 8 + content.iter().map(|part| part.len()).sum::<usize>();
    let mut bytes = Vec::with_capacity(length);
    bytes.extend((length as u32).to_be_bytes());
    bytes.extend(name);
    content.iter().for_each(|part| bytes.extend(*part));
    bytes
}

/// A box with a version and flags.
fn full(name: &[u8; 4], flags: u32, content: &[u32]) -> Vec<u8> {
    let words: Vec<u8> = std::iter::once(flags).chain(content.iter().copied()).flat_map(u32::to_be_bytes).collect();
    boxed(name, &[&words])
}

/// The unit matrix of a picture that is neither turned nor moved.
const MATRIX: [u32; 9] = [0x10000, 0, 0, 0, 0x10000, 0, 0, 0, 0x4000_0000];

impl Mp4Writer {
    pub fn create(path: &Path, width: usize, height: usize, (frames, seconds): (u32, u32)) -> Result<Mp4Writer, MediaError> {
        let mut file = WholeFile::create(path)?;
        let mut head = boxed(b"ftyp", &[b"isom", &512u32.to_be_bytes(), b"isomiso2avc1mp41"]);
        let data_start = head.len() as u64 + 16;
        // A length of 1 says that the true one follows in 64 bits.
        head.extend(1u32.to_be_bytes());
        head.extend(b"mdat");
        head.extend(0u64.to_be_bytes());
        file.write_all(&head).map_err(|e| MediaError::io(path, "write", e))?;
        // Fine enough for any rate, and a whole number of units a picture.
        let factor = (1000 / frames).max(1);
        Ok(Mp4Writer {
            file,
            width,
            height,
            time_scale: frames * factor,
            duration: seconds * factor,
            sizes: Vec::new(),
            keys: Vec::new(),
            data_start,
            data_bytes: 0,
        })
    }

    /// Adds a picture that is one NAL unit.
    pub fn push(&mut self, unit: &[u8], key: bool) -> Result<(), MediaError> {
        let path = self.file.path().to_owned();
        let failed = |e| MediaError::io(&path, "write", e);
        self.file.write_all(&(unit.len() as u32).to_be_bytes()).map_err(failed)?;
        self.file.write_all(unit).map_err(failed)?;
        self.sizes.push(unit.len() as u32 + 4);
        self.data_bytes += unit.len() as u64 + 4;
        if key {
            self.keys.push(self.sizes.len() as u32);
        }
        Ok(())
    }

    /// Writes the index and ends the file.
    pub fn finish(mut self, sequence: &[u8], picture: &[u8]) -> Result<(), MediaError> {
        let path = self.file.path().to_owned();
        if self.sizes.is_empty() {
            return Err(MediaError::Size(format!("{}: a video needs at least one frame", path.display())));
        }
        let index = self.index(sequence, picture);
        let failed = |e| MediaError::io(&path, "write", e);
        self.file.write_all(&index).map_err(failed)?;
        self.file.seek(SeekFrom::Start(self.data_start - 8)).map_err(failed)?;
        self.file.write_all(&(self.data_bytes + 16).to_be_bytes()).map_err(failed)?;
        self.file.finish()
    }

    fn index(&self, sequence: &[u8], picture: &[u8]) -> Vec<u8> {
        let count = self.sizes.len() as u32;
        let length = count * self.duration;
        let (width, height) = (self.width.next_multiple_of(2) as u32, self.height.next_multiple_of(2) as u32);

        let mut decoder = vec![1, sequence[1], sequence[2], sequence[3], 0xff, 0xe1];
        decoder.extend((sequence.len() as u16).to_be_bytes());
        decoder.extend(sequence);
        decoder.push(1);
        decoder.extend((picture.len() as u16).to_be_bytes());
        decoder.extend(picture);
        let decoder = boxed(b"avcC", &[&decoder]);
        let mut entry = vec![0; 78];
        entry[7] = 1; // data reference
        entry[24..26].copy_from_slice(&(width as u16).to_be_bytes());
        entry[26..28].copy_from_slice(&(height as u16).to_be_bytes());
        entry[28..32].copy_from_slice(&0x0048_0000u32.to_be_bytes()); // 72 dots an inch, as everyone writes
        entry[32..36].copy_from_slice(&0x0048_0000u32.to_be_bytes());
        entry[41] = 1; // pictures a sample
        entry[74..78].copy_from_slice(&[0, 24, 0xff, 0xff]); // depth, no colour table
        let entry = boxed(b"avc1", &[&entry, &decoder]);
        let descriptions = boxed(b"stsd", &[&0u32.to_be_bytes(), &1u32.to_be_bytes(), &entry]);

        let times = full(b"stts", 0, &[1, count, self.duration]);
        let mut key_words = vec![self.keys.len() as u32];
        key_words.extend(&self.keys);
        let keys = full(b"stss", 0, &key_words);
        // All pictures lie in one piece.
        let pieces = full(b"stsc", 0, &[1, 1, count, 1]);
        let mut size_words = vec![0, count];
        size_words.extend(&self.sizes);
        let sizes = full(b"stsz", 0, &size_words);
        let places = full(b"stco", 0, &[1, self.data_start as u32]);
        let table = boxed(b"stbl", &[&descriptions, &times, &keys, &pieces, &sizes, &places]);

        let here = full(b"url ", 1, &[]);
        let references = boxed(b"dinf", &[&boxed(b"dref", &[&0u32.to_be_bytes(), &1u32.to_be_bytes(), &here])]);
        let information = boxed(b"minf", &[&full(b"vmhd", 1, &[0, 0]), &references, &table]);
        // Language "und", packed in five bits a letter.
        let media_head = full(b"mdhd", 0, &[0, 0, self.time_scale, length, 0x55c4_0000]);
        let handler = boxed(b"hdlr", &[&[0; 8], b"vide", &[0; 12], b"video\0"]);
        let media = boxed(b"mdia", &[&media_head, &handler, &information]);
        let mut track_words = vec![0, 0, 1, 0, length, 0, 0, 0, 0];
        track_words.extend(MATRIX);
        track_words.extend([width << 16, height << 16]);
        let track = boxed(b"trak", &[&full(b"tkhd", 3, &track_words), &media]);
        let mut movie_words = vec![0, 0, self.time_scale, length, 0x10000, 0x0100_0000, 0, 0];
        movie_words.extend(MATRIX);
        movie_words.extend([0, 0, 0, 0, 0, 0, 2]);
        boxed(b"moov", &[&full(b"mvhd", 0, &movie_words), &track])
    }
}
