// The report page in a real browser with real input.
#include "cli/compare/report_page.h" // before cmocka, whose fail() is a macro

#include "cli/browser.h"
#include "cli/program.h"
#include "cli/report_sample.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { WIDTH = 1200, HEIGHT = 900, ARROW_LEFT = 37, ARROW_RIGHT = 39 };

struct fixture {
    struct browser *browser;
    char folder[300], page[400];
};

// Writes the page and releases the report.
static void write_page(struct fixture *f, json_t *report)
{
    assert_int_equal(report_page_write(f->folder, report), DONE);
    snprintf(f->page, sizeof f->page, "%s/report.html", f->folder);
    json_decref(report);
}

// All tests share one browser and reload their page.
static struct browser *shared;

static bool close_shared(void)
{
    if (shared) browser_close(shared);
    return true;
}

// A member of the report is set; takes over the value. key NULL: none.
static void begin_with(struct fixture *f, const char *name, const char *key, json_t *value)
{
    if (!shared) {
        shared = browser_open();
        test_register_end(close_shared);
    }
    f->browser = shared;
    snprintf(f->folder, sizeof f->folder, "%s", make_folder(name));
    json_t *report = sample_report(f->folder, "@cornell", "none");
    if (key) json_object_set_new(report, key, value);
    write_page(f, report);
    browser_load(f->browser, f->page, WIDTH, HEIGHT);
}

static void begin(struct fixture *f, const char *name)
{
    begin_with(f, name, NULL, NULL);
}

static void end(struct fixture *f)
{
    CHECK_STRING(browser_complaints(f->browser), "");
}

struct box {
    double x, y, width, height;
};

static struct box box_of(struct fixture *f, const char *selector)
{
    static const char *const members[] = { "x", "y", "width", "height" };
    double values[4];
    for (int i = 0; i < 4; i++)
        values[i] =
            browser_number(f->browser, "document.querySelector('%s').getBoundingClientRect().%s",
                           selector, members[i]);
    return (struct box){ values[0], values[1], values[2], values[3] };
}

static struct box stage_in_sight(struct fixture *f)
{
    browser_true(f->browser, "document.querySelector('#stage').scrollIntoView()");
    return box_of(f, "#stage");
}

// Share of the left image, from its clip.
static double split_of(struct fixture *f)
{
    return 1 - browser_number(
                   f->browser,
                   "parseFloat(getComputedStyle(document.querySelector('#left-half')).clipPath"
                   ".replace(/^inset\\(0(px)? /, '')) / 100");
}

// Scrolled elements receive the pointer only after frames are drawn.
static void let_frames_pass(struct fixture *f)
{
    browser_true(f->browser, "new Promise(done => requestAnimationFrame(() => "
                             "requestAnimationFrame(() => done(true))))");
}

static void click(struct fixture *f, const char *selector)
{
    let_frames_pass(f);
    struct box box = box_of(f, selector);
    double x = box.x + box.width / 2, y = box.y + box.height / 2;
    browser_mouse(f->browser, "mouseMoved", x, y, 0);
    browser_mouse(f->browser, "mousePressed", x, y, 1);
    browser_mouse(f->browser, "mouseReleased", x, y, 1);
}

static void drag(struct fixture *f, double from_x, double from_y, double to_x, double to_y)
{
    browser_mouse(f->browser, "mouseMoved", from_x, from_y, 0);
    browser_mouse(f->browser, "mousePressed", from_x, from_y, 1);
    for (int i = 1; i <= 4; i++)
        browser_mouse(f->browser, "mouseMoved", from_x + (to_x - from_x) * i / 4,
                      from_y + (to_y - from_y) * i / 4, 1);
    browser_mouse(f->browser, "mouseReleased", to_x, to_y, 1);
}

// Input passes through other threads of the browser than the query for its effect.
static bool becomes_true(struct fixture *f, const char *expression)
{
    for (int i = 0; i < 250 * test_time_factor(); i++) {
        if (browser_true(f->browser, "%s", expression)) return true;
        test_pause_ms(20);
    }
    return false;
}

TEST(the_divider_follows_the_pointer_and_the_arrow_keys)
{
    struct fixture f = { 0 };
    begin(&f, "divider");
    struct box stage = stage_in_sight(&f);
    CHECK_NEAR(split_of(&f), 0.5, 1e-3);
    double y = stage.y + 0.6 * stage.height;
    drag(&f, stage.x + 0.5 * stage.width, y, stage.x + 0.2 * stage.width, y);
    CHECK_NEAR(split_of(&f), 0.2, 2 / stage.width); // of a pixel or two
    CHECK_NEAR(box_of(&f, ".divider").x - stage.x, 0.2 * stage.width, 3);
    // The range input has the focus; its step is a hundredth.
    browser_key(f.browser, "ArrowRight", ARROW_RIGHT);
    browser_key(f.browser, "ArrowRight", ARROW_RIGHT);
    CHECK_NEAR(split_of(&f), 0.22, 1e-3);
    browser_key(f.browser, "ArrowLeft", ARROW_LEFT);
    CHECK_NEAR(split_of(&f), 0.21, 1e-3);
    browser_key(f.browser, "f", 'F');
    CHECK_NEAR(split_of(&f), 1.0, 1e-6);
    browser_key(f.browser, "f", 'F');
    CHECK_NEAR(split_of(&f), 0.0, 1e-6);
    end(&f);
}

// Position of the image point that began at (u, v), 0…1, as a share of the frame.
static double place_of(struct fixture *f, const char *frame, char axis, double u)
{
    char image[64];
    snprintf(image, sizeof image, "%s img", frame);
    struct box outer = box_of(f, frame), inner = box_of(f, image);
    return axis == 'x' ? (inner.x - outer.x + u * inner.width) / outer.width
                       : (inner.y - outer.y + u * inner.height) / outer.height;
}

TEST(the_wheel_zooms_about_the_pointer_in_all_images_alike)
{
    struct fixture f = { 0 };
    begin(&f, "zoom");
    struct box stage = stage_in_sight(&f);
    double u = 0.3, v = 0.6;
    browser_mouse(f.browser, "mouseMoved", stage.x + u * stage.width, stage.y + v * stage.height,
                  0);
    for (int i = 0; i < 8; i++)
        browser_wheel(f.browser, stage.x + u * stage.width, stage.y + v * stage.height, -120);
    CHECK(becomes_true(&f, "parseInt(document.querySelector('#zoom').value) > 1500"));
    CHECK(box_of(&f, "#stage img").width > 5 * stage.width);
    static const char *const frames[] = { "#stage", ".tile:nth-child(1) .view",
                                          ".tile:nth-child(3) .view" };
    for (int i = 0; i < 3; i++) {
        CHECK_NEAR(place_of(&f, frames[i], 'x', u), u, 0.01);
        CHECK_NEAR(place_of(&f, frames[i], 'y', v), v, 0.01);
    }
    CHECK(browser_true(
        f.browser,
        "getComputedStyle(document.querySelector('#left-image')).imageRendering === 'pixelated'"));
    // Position and both values under the pointer: left method 3, right the reference.
    browser_mouse(f.browser, "mouseMoved", stage.x + u * stage.width + 1,
                  stage.y + v * stage.height, 0);
    browser_mouse(f.browser, "mouseMoved", stage.x + u * stage.width, stage.y + v * stage.height,
                  0);
    CHECK(becomes_true(&f,
                       "document.querySelector('#readout').textContent.startsWith('x 19, y 28')"));

    double before = place_of(&f, "#stage", 'x', u), split = split_of(&f);
    drag(&f, stage.x + 0.2 * stage.width, stage.y + 0.2 * stage.height, stage.x + 0.3 * stage.width,
         stage.y + 0.2 * stage.height);
    CHECK_NEAR(place_of(&f, "#stage", 'x', u), before + 0.1, 0.01);
    CHECK_NEAR(place_of(&f, frames[1], 'x', u), before + 0.1, 0.01);
    CHECK_NEAR(split_of(&f), split, 1e-6); // the divider stays where it is on the screen

    browser_mouse(f.browser, "mousePressed", stage.x + 10, stage.y + 0.5 * stage.height, 1);
    browser_mouse(f.browser, "mouseReleased", stage.x + 10, stage.y + 0.5 * stage.height, 1);
    browser_mouse(f.browser, "mousePressed", stage.x + 10, stage.y + 0.5 * stage.height, 2);
    browser_mouse(f.browser, "mouseReleased", stage.x + 10, stage.y + 0.5 * stage.height, 2);
    CHECK_NEAR(box_of(&f, "#stage img").width, stage.width, 0.5);
    CHECK_NEAR(split_of(&f), 0.5, 1e-6);
    end(&f);
}

TEST(the_page_scrolls_at_the_smallest_zoom)
{
    struct fixture f = { 0 };
    begin(&f, "scroll");
    struct box stage = box_of(&f, "#stage");
    double x = stage.x + 0.3 * stage.width, y = stage.y + 100;
    browser_mouse(f.browser, "mouseMoved", x, y, 0);
    browser_wheel(f.browser, x, y, 120);
    CHECK(becomes_true(&f, "scrollY > 50"));
    CHECK_NEAR(box_of(&f, "#stage img").width, stage.width, 0.5);
    end(&f);
}

// Number of non-empty pixels of a canvas, from a copy, since reading slows a canvas down.
static double drawn(struct fixture *f, const char *selector)
{
    return browser_number(f->browser,
                          "(c => { const copy = document.createElement('canvas');"
                          "Object.assign(copy, { width: c.width, height: c.height });"
                          "const context = copy.getContext('2d', { willReadFrequently: true });"
                          "context.drawImage(c, 0, 0);"
                          "return context.getImageData(0, 0, c.width, c.height).data"
                          ".reduce((n, v, i) => n + (i %% 4 === 3 && v > 0), 0);"
                          "})(document.querySelector('%s'))",
                          selector);
}

TEST(the_charts_are_drawn_in_light_and_in_dark)
{
    struct fixture f = { 0 };
    begin(&f, "charts");
    for (int dark = 0; dark < 2; dark++) {
        browser_dark(f.browser, dark);
        CHECK(browser_true(f.browser, "matchMedia('(prefers-color-scheme: dark)').matches === %s",
                           dark ? "true" : "false"));
        CHECK(drawn(&f, "#scatter-chart") > 5000); // axes, names and four points are some thousands
        CHECK(drawn(&f, "#passes-chart") > 5000);
    }
    CHECK(becomes_true(&f, "document.querySelectorAll('#error option').length === 6"));
    CHECK(browser_true(f.browser, "document.querySelectorAll('#groups li').length === 3"));
    end(&f);
}

TEST(a_click_on_a_heading_sorts_and_the_best_are_marked)
{
    struct fixture f = { 0 };
    begin(&f, "sort");
    static const char order[] =
        "[...document.querySelectorAll('#table tbody tr')].map(row => row.dataset.method).join('')";
    // In the sample the last method is closest to the reference and the first is fastest.
    CHECK(browser_true(f.browser, "%s === '0123'", order));
    CHECK(browser_true(f.browser,
                       "[...document.querySelectorAll('#table tr[data-method=\"3\"] td')]"
                       ".map(cell => cell.className === 'best').join() === "
                       "'true,true,true,true,true,true,true,false,false,false'"));
    CHECK(browser_true(f.browser,
                       "/Bold: best.*Marked row/.test(document.querySelector('#table-legend')"
                       ".textContent)"));
    click(&f, "th[data-metric=FLIP] .sort");
    CHECK(browser_true(f.browser, "%s === '3210'", order));
    CHECK(browser_true(f.browser,
                       "document.querySelector('th[data-metric=FLIP]').ariaSort === 'ascending'"));
    CHECK(browser_true(f.browser,
                       "/Lower is better/.test(document.querySelector('#tip').textContent)"));
    click(&f, "th[data-metric=FLIP] .sort");
    CHECK(browser_true(f.browser, "%s === '0123'", order));
    click(&f, "th[data-metric=SSIM] .sort");
    CHECK(browser_true(f.browser,
                       "document.querySelector('th[data-metric=SSIM]').ariaSort === 'descending'"));
    CHECK(browser_true(f.browser, "%s === '3210'", order));
    end(&f);
}

static bool stage_shows(struct fixture *f, const char *left, const char *right)
{
    return browser_true(f->browser,
                        "(p => document.querySelector('#left-image').src === p['%s'] && "
                        "document.querySelector('#right-image').src === p['%s'])"
                        "(JSON.parse(document.querySelector('#data-images').textContent))",
                        left, right);
}

TEST(a_method_has_one_colour_and_names_its_changed_options)
{
    struct fixture f = { 0 };
    begin(&f, "colours");
    CHECK(browser_true(f.browser,
                       "(c => [0, 1, 2, 3].every(i => c('#table tr[data-method=\"' + i + '\"]') "
                       "=== c('#points li:nth-child(' + (i + 1) + ')')) && "
                       "new Set([0, 1, 2, 3].map(i => c('#table tr[data-method=\"' + i + '\"]')))"
                       ".size === 4)(s => getComputedStyle(document.querySelector(s + ' .chip'))"
                       ".backgroundColor)"));
    CHECK(browser_true(f.browser, "/lpv:steps=64/.test(document.querySelector("
                                  "'#table tr[data-method=\"3\"] .method').ariaLabel)"));
    CHECK(browser_true(f.browser, "document.querySelector('#command').textContent === "
                                  "'afterglow compare @cornell'"));
    CHECK(browser_true(f.browser, "document.body.textContent.includes('sun:0,-1,0:1,1,1')"));
    CHECK(!browser_true(f.browser, "document.body.textContent.includes('mean ratio')"));
    end(&f);
}

TEST(any_two_images_can_be_compared)
{
    struct fixture f = { 0 };
    begin(&f, "pairs");
    CHECK(stage_shows(&f, "3-picture.png", "reference.png"));
    CHECK(browser_true(f.browser, "document.querySelector('#left-image').naturalWidth === %d",
                       SAMPLE_WIDTH));
    click(&f, "#table tr[data-method=\"1\"] .method");
    CHECK(stage_shows(&f, "1-picture.png", "reference.png"));
    browser_true(f.browser, "(s => { s.value = '2 picture'; s.dispatchEvent(new Event('change')); "
                            "})(document.querySelector('#right'))");
    CHECK(stage_shows(&f, "1-picture.png", "2-picture.png"));
    browser_true(f.browser, "document.querySelector('#layers').scrollIntoView()");
    click(&f, "#layers label:nth-child(2)");
    CHECK(stage_shows(&f, "1-indirect.png", "2-indirect.png"));
    browser_true(f.browser, "document.querySelector('#sheet').scrollIntoView()");
    click(&f, ".row:nth-child(1) .tile:nth-child(3) .view");
    CHECK(stage_shows(&f, "0-indirect_error.png", "2-indirect.png"));
    // Methods keep the name that was given.
    CHECK(browser_true(
        f.browser, "[...document.querySelectorAll('.method')].map(m => m.textContent).join() === "
                   "'none,ambient:strength=1,lpv:dim=16,steps=8,lpv:dim=16,steps=64'"));
    end(&f);
}

TEST(captions_state_an_exposure_of_indirect_light)
{
    static const char captions[] =
        "[...document.querySelectorAll('.row:nth-child(1) figcaption')].map(c => c.textContent)"
        ".join('; ')";
    struct fixture f = { 0 };
    begin(&f, "exposures");
    CHECK(
        browser_true(f.browser, "%s === 'Image; Reference; Error map; Indirect light'", captions));
    end(&f);
    begin_with(&f, "own-exposure", "indirect_exposure_ev", json_real(3.25));
    CHECK(browser_true(f.browser, "(%s).endsWith('Indirect light, 3.5 EV brighter')", captions));
    browser_true(f.browser, "document.querySelector('#layers').scrollIntoView()");
    click(&f, "#layers label:nth-child(2)");
    CHECK(browser_true(f.browser,
                       "%s === 'Indirect light, 3.5 EV brighter; Reference, 3.5 EV "
                       "brighter; Error map; Image'",
                       captions));
    end(&f);
}

TEST(names_are_never_parsed_as_html)
{
    static const char scene[] = "</script><script>window.caught = 1</script><!--";
    static const char gi[] = "<img src=x onerror='window.caught = 1'>";
    struct fixture f = { 0 };
    begin(&f, "names");
    write_page(&f, sample_report(f.folder, scene, gi));
    browser_load(f.browser, f.page, WIDTH, HEIGHT);
    CHECK(browser_true(f.browser, "window.caught === undefined"));
    json_t *heading = browser_value(f.browser, "document.querySelector('h1').textContent");
    CHECK_STRING(json_string_value(heading), scene);
    json_decref(heading);
    CHECK(browser_true(f.browser,
                       "document.querySelector('.method').textContent.startsWith('<img')"));
    end(&f);
}

TEST(missing_values_are_left_out)
{
    struct fixture f = { 0 };
    begin(&f, "lacking");
    static const char *const reports[] = {
        "{}",
        "{\"scene\": null, \"methods\": []}",
        "{\"methods\": [{\"gi\": \"none\", \"frame_ms\": {\"median\": null, \"p95\": null}, "
        "\"flip\": 0.5}]}",
        "{\"size\": [64, 48], \"methods\": [{\"gi\": \"none\", \"images\": {\"picture\": "
        "\"0-picture.png\"}}, {}]}",
        "{\"size\": [64, 48], \"reference\": {\"images\": {\"indirect\": "
        "\"reference-indirect.png\"}}}",
    };
    for (size_t i = 0; i < sizeof reports / sizeof *reports; i++) {
        write_page(&f, json_loads(reports[i], 0, NULL));
        browser_load(f.browser, f.page, WIDTH, HEIGHT);
        CHECK_STRING(browser_complaints(f.browser), "");
        CHECK(browser_true(f.browser, "document.querySelector('#scatter').hidden"));
        CHECK(browser_true(f.browser, "document.querySelector('#viewer').hidden === %s",
                           i < 3 ? "true" : "false"));
    }
    end(&f);
}

TEST(a_narrow_screen_scrolls_down_only)
{
    struct fixture f = { 0 };
    begin(&f, "narrow");
    browser_load(f.browser, f.page, 360, 740);
    CHECK(browser_true(f.browser, "document.documentElement.scrollWidth <= 360"));
    CHECK(box_of(&f, "#stage").width > 300);
    end(&f);
}
