//! Pages of `view` and `export --to html`: content, error of rounding, selection, messages. `.ci/view` operates pages in a
//! browser.

use std::fs;
use std::io::Read;
use std::path::Path;

use base64::prelude::{BASE64_STANDARD, Engine as _};
use pericles_run::Results;
use serde_json::Value;

use crate::common::{PLATE, fail, succeed, text, with_plate};

/// A page as a browser decodes it.
pub struct Page {
    text: String,
    header: Value,
    blocks: Vec<Vec<u8>>,
}

impl Page {
    /// Opens a page and checks that it loads nothing and that its arrays fit together.
    pub fn open(path: &Path) -> Self {
        let text = fs::read_to_string(path).unwrap();
        let element = |start: &str| {
            let (_, rest) = text.split_once(start).unwrap();
            rest.split_once("</script>").unwrap().0
        };
        let header = serde_json::from_str(element("id=\"header\">")).unwrap();
        let mut blocks = Vec::new();
        while text.contains(&format!("id=\"b{}\">", blocks.len())) {
            let packed = element(&format!("id=\"b{}\">", blocks.len()));
            let packed = BASE64_STANDARD.decode(packed).unwrap();
            let mut bytes = Vec::new();
            let mut decoder = flate2::read::ZlibDecoder::new(&packed[..]);
            decoder.read_to_end(&mut bytes).unwrap();
            blocks.push(bytes);
        }
        let page = Self {
            text,
            header,
            blocks,
        };
        page.check();
        page
    }

    /// Returns the number of output times.
    pub fn times(&self) -> usize {
        self.list("/times").len()
    }

    fn check(&self) {
        for word in [
            " src=",
            " href=",
            "@import",
            "url(",
            "fetch(",
            "import(",
            "XMLHttpRequest",
            "WebSocket",
            "EventSource",
            "sendBeacon",
        ] {
            assert!(!self.text.contains(word), "{word}");
        }
        let n = self.count("/points");
        assert_eq!(self.words::<4>("/positions").len(), 3 * n);
        assert_eq!(self.words::<4>("/radii").len(), n);
        for set in self.list("/sets") {
            let members = self.u32(&set["points"]);
            assert!(members.iter().all(|&i| (i as usize) < n));
        }
        for field in self.list("/fields") {
            let components = field["components"].as_array().unwrap().len().max(1);
            let frames = field["frames"].as_array().unwrap();
            assert_eq!(frames.len(), self.times());
            for frame in frames {
                assert_eq!(self.u16(&frame["block"]).len(), components * n);
            }
        }
        if !self.header["cells"].is_null() {
            let points = self.u32(self.value("/cells/points"));
            let across = self.u32(self.value("/cells/across"));
            let cells = points.len() as u32;
            assert!(points.iter().all(|&i| (i as usize) < n));
            assert!(across.iter().all(|&cell| cell < cells || cell == u32::MAX));
            let nodes = self.words::<4>("/cells/nodes").len() as u32 / 3;
            let corners = self.u32(self.value("/cells/corners"));
            assert!(corners.iter().all(|&node| node < nodes));
        }
        if !self.header["triangles"].is_null() {
            let corners = self.u32(self.value("/triangles"));
            assert!(corners.iter().all(|&i| (i as usize) < n));
        }
    }

    fn value(&self, pointer: &str) -> &Value {
        self.header.pointer(pointer).unwrap()
    }

    fn count(&self, pointer: &str) -> usize {
        self.value(pointer).as_u64().unwrap() as usize
    }

    fn list(&self, pointer: &str) -> &[Value] {
        self.value(pointer).as_array().unwrap()
    }

    fn names(&self, pointer: &str) -> Vec<&str> {
        let names = self.list(pointer).iter();
        names.map(|one| one["name"].as_str().unwrap()).collect()
    }

    /// Returns the words of a block, whose bytes are grouped by significance.
    fn words_of<const BYTES: usize>(&self, block: &Value) -> Vec<[u8; BYTES]> {
        let bytes = &self.blocks[block.as_u64().unwrap() as usize];
        let count = bytes.len() / BYTES;
        let word = |k: usize| std::array::from_fn(|byte| bytes[byte * count + k]);
        (0..count).map(word).collect()
    }

    fn words<const BYTES: usize>(&self, pointer: &str) -> Vec<[u8; BYTES]> {
        self.words_of(self.value(pointer))
    }

    fn u16(&self, block: &Value) -> Vec<u16> {
        let differences = self.words_of(block).into_iter().map(u16::from_le_bytes);
        let sum = |sum: &mut u16, difference| {
            *sum = sum.wrapping_add(difference);
            Some(*sum)
        };
        differences.scan(0, sum).collect()
    }

    fn u32(&self, block: &Value) -> Vec<u32> {
        let differences = self.words_of(block).into_iter().map(u32::from_le_bytes);
        let sum = |sum: &mut u32, difference| {
            *sum = sum.wrapping_add(difference);
            Some(*sum)
        };
        differences.scan(0, sum).collect()
    }

    fn f64(&self, block: &Value) -> Vec<f64> {
        let words = self.words_of(block).into_iter();
        words.map(f64::from_le_bytes).collect()
    }
}

#[test]
fn values_of_a_page_are_those_of_the_run_to_within_half_a_step() {
    let place = with_plate();
    let folder = place.path();
    succeed(folder, "run plate.toml --out a --quiet");
    let output = succeed(folder, "view a --no-open");
    assert!(text(&output.stdout).contains("fields.html: 6 output times"));
    let page = Page::open(&folder.join("a/fields.html"));
    assert_eq!(page.value("/title"), "Torn plate");
    let states = Results::open(&folder.join("a")).unwrap().fields().unwrap();
    let n = page.count("/points");
    for (frame, state) in states.iter().enumerate() {
        let data = state.read().unwrap();
        assert_eq!(page.list("/times")[frame].as_f64().unwrap(), state.time);
        for field in page.list("/fields") {
            let exact = data.field(field["name"].as_str().unwrap()).unwrap();
            let shown = &field["frames"][frame];
            let codes = page.u16(&shown["block"]);
            for (c, codes) in codes.chunks(n).enumerate() {
                let number = |key: &str| shown[key][c].as_f64().unwrap();
                let (low, step) = (number("low"), number("step"));
                for (i, &code) in codes.iter().enumerate() {
                    let value = exact.values[exact.components * i + c];
                    let error = (low + step * f64::from(code) - value).abs();
                    assert!(error <= 0.501 * step + 1e-14 * value.abs());
                }
                // The error that the book states, relative to the range.
                let range = &shown["ranges"][c];
                let range = range[1].as_f64().unwrap() - range[0].as_f64().unwrap();
                assert!(range == 0.0 || step * 0.5 <= 8e-6 * range || step == 1.0);
            }
        }
    }
    // The magnitude of vectors has a range of its own.
    let displacement = &page.list("/fields")[0];
    let largest = displacement["ranges"][2][1].as_f64().unwrap();
    let last = states[5].read().unwrap();
    let last = last.field("Displacement").unwrap();
    let norms = last.values.chunks(3).map(|u| u[0].hypot(u[1]));
    assert!(largest >= norms.fold(0.0, f64::max));
}

#[test]
fn a_page_has_cells_pre_cracks_sets_and_time_histories() {
    let place = with_plate();
    let folder = place.path();
    succeed(folder, "run plate.toml --out a --quiet");
    succeed(folder, "export a --to html");
    let page = Page::open(&folder.join("a/fields.html"));
    // 24 × 12 cells, of which eight pairs are separated by the pre-crack.
    assert_eq!(page.u32(page.value("/cells/points")).len(), 288);
    let across = page.u32(page.value("/cells/across"));
    let outer = across.iter().filter(|&&cell| cell == u32::MAX).count();
    assert_eq!((across.len(), outer), (4 * 288, 72));
    let cut = page.u32(page.value("/cells/cut"));
    assert_eq!(cut.iter().sum::<u32>(), 16);
    assert_eq!(page.u32(page.value("/lines/lengths")).len(), 2);
    assert_eq!(page.names("/sets"), ["top", "bottom"]);
    let top = page.u32(&page.list("/sets")[0]["points"]);
    assert_eq!(top, (264..288).collect::<Vec<u32>>());
    let names = page.names("/tables");
    assert!(
        ["cracks", "history", "probes", "reactions"]
            .iter()
            .all(|name| names.contains(name))
    );
    let exact = pericles_io::read_csv(folder.join("a/history.csv")).unwrap();
    let history = page
        .list("/tables")
        .iter()
        .find(|table| table["name"] == "history");
    let history = history.unwrap();
    assert_eq!(page.f64(&history["time"]), exact.column("time").unwrap());
    let columns = history["columns"].as_array().unwrap();
    let kinetic = columns
        .iter()
        .find(|column| column["name"] == "kinetic_energy")
        .unwrap();
    assert_eq!(
        page.f64(&kinetic["block"]),
        exact.column("kinetic_energy").unwrap()
    );
    assert_eq!(kinetic["unit"], "J/m");
}

#[test]
fn output_times_and_fields_are_selected_and_omissions_are_reported() {
    let place = with_plate();
    let folder = place.path();
    succeed(folder, "run plate.toml --out a --quiet");
    let page = || Page::open(&folder.join("a/fields.html"));
    let output = succeed(folder, "view a --no-open --every 2 --fields damage");
    // 0, 2, 4 and the last one. Cells move with the displacement.
    assert_eq!(page().times(), 4);
    assert_eq!(page().names("/fields"), ["Damage", "Displacement"]);
    let note = "4 of 6 output times are shown.";
    assert!(
        text(&output.stderr).contains(note),
        "{}",
        text(&output.stderr)
    );
    assert_eq!(page().value("/notes")[0], note);

    let output = succeed(folder, "view a --no-open --max-size 10kB");
    let notes = text(&output.stderr);
    assert!(
        notes.contains("more than 10.0 kB") && page().times() < 6,
        "{notes}"
    );
    succeed(folder, "export a --to csv --every 5 --fields Displacement");
    assert_eq!(
        fs::read_dir(folder.join("a/fields-csv")).unwrap().count(),
        2
    );
    let table = pericles_io::read_csv(folder.join("a/fields-csv/fields_000001.csv")).unwrap();
    assert!(table.column("Displacement_x").is_some() && table.column("Damage").is_none());

    let (status, message) = fail(folder, "view a --no-open --fields Damages");
    assert!(
        message.contains("there is no field \"Damages\"")
            && message.contains("did you mean Damage?"),
        "{message}"
    );
    assert_eq!(status, 2);
    assert_eq!(fail(folder, "view a --every 0").0, 2);
    assert_eq!(fail(folder, "view a --every 2 --max-size 1MB").0, 2);
    let (_, message) = fail(folder, "export a --to html");
    assert!(message.contains("already exists"), "{message}");
    let (_, message) = fail(folder, "view nowhere --no-open");
    assert!(
        message.contains("is not the output folder of a run"),
        "{message}"
    );
    let deck = PLATE.replace("fields = { every = 90 }", "fields = \"never\"");
    fs::write(folder.join("b.toml"), deck).unwrap();
    succeed(folder, "run b.toml --out b --quiet");
    let (_, message) = fail(folder, "view b --no-open");
    assert!(message.contains("contains no field files"), "{message}");
}

#[test]
fn a_page_of_several_steps_has_one_time_line() {
    let place = tempfile::tempdir().unwrap();
    let folder = place.path();
    let steps = "[[step]]\nname = \"stretch\"\ntime = { end = \"10 us\" }\n[[step]]\nname = \"release\"\ntime = { end = \"20 us\" }\n";
    let deck = format!(
        "[body]\nshape = \"bar\"\nlength = \"20 mm\"\nspacing = \"1 mm\"\n[material]\nyoungs_modulus = \"72 GPa\"\ndensity = 2440\nhorizon_ratio = 3\n[[initial]]\nvelocity = [1]\n[time]\nend = 1\n[output]\nfields = {{ count = 4 }}\n{steps}"
    );
    fs::write(folder.join("a.toml"), deck).unwrap();
    succeed(folder, "run a.toml --out a --quiet");
    succeed(folder, "view a --no-open --out page.html");
    let page = Page::open(&folder.join("page.html"));
    assert_eq!(page.names("/steps"), ["1-stretch", "2-release"]);
    let times: Vec<f64> = page
        .list("/times")
        .iter()
        .map(|t| t.as_f64().unwrap())
        .collect();
    assert_eq!(times.len(), 9);
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]));
    let start = page.value("/steps/1/start").as_f64().unwrap();
    assert!((start - 1e-5).abs() < 1e-7 && (times[8] - 3e-5).abs() < 1e-7);
}
