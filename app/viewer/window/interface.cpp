// The one C++ file: Dear ImGui behind interface.h.
#include "interface.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_vulkan.h>
#include <imgui.h>

#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace {

enum { FONT_IMAGES = 1, MAX_ELEMENTS = 512, LABEL_SIZE = 96 };

VkDescriptorPool pool;
VkDevice device;
struct interface_desc desc;

// Elements of the newest frame that are in view, for scripts.
struct element {
    char label[LABEL_SIZE];
    float x, y;
};
element elements[MAX_ELEMENTS];
int element_count;

bool seen(const char *label, bool changed)
{
    if (element_count < MAX_ELEMENTS && ImGui::IsItemVisible()) {
        element &e = elements[element_count++];
        const ImVec2 a = ImGui::GetItemRectMin(), b = ImGui::GetItemRectMax();
        snprintf(e.label, sizeof e.label, "%s", label);
        e.x = 0.5f * (a.x + b.x);
        e.y = 0.5f * (a.y + b.y);
    }
    return changed;
}

// ---- keys

const struct {
    int glfw;
    ImGuiKey imgui;
} keys[] = {
    { GLFW_KEY_TAB, ImGuiKey_Tab },
    { GLFW_KEY_LEFT, ImGuiKey_LeftArrow },
    { GLFW_KEY_RIGHT, ImGuiKey_RightArrow },
    { GLFW_KEY_UP, ImGuiKey_UpArrow },
    { GLFW_KEY_DOWN, ImGuiKey_DownArrow },
    { GLFW_KEY_PAGE_UP, ImGuiKey_PageUp },
    { GLFW_KEY_PAGE_DOWN, ImGuiKey_PageDown },
    { GLFW_KEY_HOME, ImGuiKey_Home },
    { GLFW_KEY_END, ImGuiKey_End },
    { GLFW_KEY_DELETE, ImGuiKey_Delete },
    { GLFW_KEY_BACKSPACE, ImGuiKey_Backspace },
    { GLFW_KEY_SPACE, ImGuiKey_Space },
    { GLFW_KEY_ENTER, ImGuiKey_Enter },
    { GLFW_KEY_ESCAPE, ImGuiKey_Escape },
    { GLFW_KEY_A, ImGuiKey_A },
    { GLFW_KEY_C, ImGuiKey_C },
    { GLFW_KEY_V, ImGuiKey_V },
    { GLFW_KEY_X, ImGuiKey_X },
    { GLFW_KEY_Y, ImGuiKey_Y },
    { GLFW_KEY_Z, ImGuiKey_Z },
};

#if IMGUI_VERSION_NUM >= 18700
void set_mouse(ImGuiIO &io, float x, float y)
{
    io.AddMousePosEvent(x, y);
}
void set_button(ImGuiIO &io, int button, bool down)
{
    io.AddMouseButtonEvent(button, down);
}
void set_wheel(ImGuiIO &io, float x, float y)
{
    io.AddMouseWheelEvent(x, y);
}
void map_keys(ImGuiIO &)
{
}
void set_key(ImGuiIO &io, const struct event *event)
{
    io.AddKeyEvent(ImGuiMod_Shift, (event->modifiers & MODIFIER_SHIFT) != 0);
    io.AddKeyEvent(ImGuiMod_Ctrl, (event->modifiers & MODIFIER_CONTROL) != 0);
    io.AddKeyEvent(ImGuiMod_Alt, (event->modifiers & MODIFIER_ALT) != 0);
    for (const auto &key : keys)
        if (key.glfw == event->code) io.AddKeyEvent(key.imgui, event->down);
}
#else
void set_mouse(ImGuiIO &io, float x, float y)
{
    io.MousePos = ImVec2(x, y);
}
void set_button(ImGuiIO &io, int button, bool down)
{
    io.MouseDown[button] = down;
}
void set_wheel(ImGuiIO &io, float x, float y)
{
    io.MouseWheelH += x;
    io.MouseWheel += y;
}
void map_keys(ImGuiIO &io)
{
    for (const auto &key : keys) io.KeyMap[key.imgui] = key.glfw;
}
void set_key(ImGuiIO &io, const struct event *event)
{
    if (event->code < 0 || event->code >= 512) return;
    io.KeysDown[event->code] = event->down;
    io.KeyShift = (event->modifiers & MODIFIER_SHIFT) != 0;
    io.KeyCtrl = (event->modifiers & MODIFIER_CONTROL) != 0;
    io.KeyAlt = (event->modifiers & MODIFIER_ALT) != 0;
}
#endif

const char *get_clipboard(void *)
{
    return desc.clipboard(desc.user);
}
void set_clipboard(void *, const char *text)
{
    desc.set_clipboard(desc.user, text);
}

// ---- look

void style(float scale)
{
    ImGui::StyleColorsDark();
    ImGuiStyle &s = ImGui::GetStyle();
    s.WindowRounding = 0;
    s.FrameRounding = 3;
    s.GrabRounding = 3;
    s.WindowBorderSize = 0;
    s.ItemSpacing = ImVec2(8, 5);
    s.Colors[ImGuiCol_WindowBg] = ImVec4(0.10f, 0.10f, 0.11f, 1.0f);
    s.ScaleAllSizes(scale);
    ImGuiIO &io = ImGui::GetIO();
    ImFontConfig font;
    font.SizePixels = 13.0f * scale;
    io.Fonts->AddFontDefault(&font);
}

bool upload_font()
{
#if IMGUI_VERSION_NUM >= 19000
    return ImGui_ImplVulkan_CreateFontsTexture();
#else
    const struct gpu *gpu = desc.gpu;
    const VkCommandBuffer commands = desc.swapchain->frames[0].commands;
    VkCommandBufferBeginInfo begin = {};
    begin.sType = VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO;
    begin.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    VkSubmitInfo submit = {};
    submit.sType = VK_STRUCTURE_TYPE_SUBMIT_INFO;
    submit.commandBufferCount = 1;
    submit.pCommandBuffers = &commands;
    const bool done = vkResetCommandPool(device, desc.swapchain->frames[0].pool, 0) == VK_SUCCESS &&
                      vkBeginCommandBuffer(commands, &begin) == VK_SUCCESS &&
                      ImGui_ImplVulkan_CreateFontsTexture(commands) &&
                      vkEndCommandBuffer(commands) == VK_SUCCESS &&
                      vkQueueSubmit(gpu->queue, 1, &submit, VK_NULL_HANDLE) == VK_SUCCESS &&
                      vkQueueWaitIdle(gpu->queue) == VK_SUCCESS;
    ImGui_ImplVulkan_DestroyFontUploadObjects();
    return done;
#endif
}

bool create_pool()
{
    const VkDescriptorPoolSize size = { VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, FONT_IMAGES };
    VkDescriptorPoolCreateInfo info = {};
    info.sType = VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO;
    info.flags = VK_DESCRIPTOR_POOL_CREATE_FREE_DESCRIPTOR_SET_BIT;
    info.maxSets = FONT_IMAGES;
    info.poolSizeCount = 1;
    info.pPoolSizes = &size;
    return vkCreateDescriptorPool(device, &info, nullptr, &pool) == VK_SUCCESS;
}

ImU32 color(uint32_t rgba)
{
    return IM_COL32(rgba >> 24, rgba >> 16 & 255, rgba >> 8 & 255, rgba & 255);
}

} // namespace

bool interface_open(const struct interface_desc *wanted)
{
    desc = *wanted;
    device = desc.gpu->device;
    pool = VK_NULL_HANDLE;
    ImGui::CreateContext();
    ImGuiIO &io = ImGui::GetIO();
    io.IniFilename = nullptr;
    io.GetClipboardTextFn = get_clipboard;
    io.SetClipboardTextFn = set_clipboard;
    io.ConfigInputTextCursorBlink = false; // images are the same each time
    map_keys(io);
    style(desc.scale);
    if (!create_pool()) return false;
    ImGui_ImplVulkan_InitInfo info = {};
    info.Instance = desc.gpu->instance;
    info.PhysicalDevice = desc.gpu->physical;
    info.Device = device;
    info.QueueFamily = desc.gpu->family;
    info.Queue = desc.gpu->queue;
    info.DescriptorPool = pool;
    info.MinImageCount = desc.swapchain->least < 2 ? 2 : desc.swapchain->least;
    info.ImageCount = SWAPCHAIN_IMAGES;
    info.MSAASamples = VK_SAMPLE_COUNT_1_BIT;
    return ImGui_ImplVulkan_Init(&info, desc.swapchain->pass) && upload_font();
}

void interface_close(void)
{
    if (!ImGui::GetCurrentContext()) return;
    if (ImGui::GetIO().BackendRendererUserData) ImGui_ImplVulkan_Shutdown();
    ImGui::DestroyContext();
    vkDestroyDescriptorPool(device, pool, nullptr);
}

void interface_event(const struct event *event)
{
    ImGuiIO &io = ImGui::GetIO();
    switch (event->kind) {
    case EVENT_MOUSE:
        set_mouse(io, event->x, event->y);
        break;
    case EVENT_BUTTON:
        if (event->code >= 0 && event->code < 5) set_button(io, event->code, event->down);
        break;
    case EVENT_SCROLL:
        set_wheel(io, event->x, event->y);
        break;
    case EVENT_KEY:
        set_key(io, event);
        break;
    case EVENT_TEXT:
        io.AddInputCharacter(static_cast<unsigned>(event->code));
        break;
    case EVENT_DROP:
    case EVENT_FOCUS:
        break;
    }
}

void interface_begin(int width, int height, float seconds)
{
    ImGuiIO &io = ImGui::GetIO();
    io.DisplaySize = ImVec2(static_cast<float>(width), static_cast<float>(height));
    io.DeltaTime = seconds > 1e-4f ? seconds : 1e-4f;
    element_count = 0;
    ImGui_ImplVulkan_NewFrame();
    ImGui::NewFrame();
}

void interface_end(VkCommandBuffer commands)
{
    ImGui::Render();
    ImGui_ImplVulkan_RenderDrawData(ImGui::GetDrawData(), commands);
}

void interface_skip(void)
{
    ImGui::EndFrame();
}

bool interface_wants_mouse(void)
{
    return ImGui::GetIO().WantCaptureMouse;
}
bool interface_wants_keys(void)
{
    return ImGui::GetIO().WantTextInput;
}

bool interface_is_held(void)
{
    return ImGui::IsAnyItemActive();
}

bool interface_find(const char *label, float *x, float *y)
{
    for (int i = 0; i < element_count; i++) {
        if (strcmp(elements[i].label, label) != 0) continue;
        *x = elements[i].x;
        *y = elements[i].y;
        return true;
    }
    return false;
}

bool interface_element(unsigned number, float *x, float *y)
{
    if (element_count == 0) return false;
    const element &e = elements[number % static_cast<unsigned>(element_count)];
    *x = e.x;
    *y = e.y;
    return true;
}

// ---- elements

bool ui_panel_begin(const char *title, float x, float y, float width, float height)
{
    ImGui::SetNextWindowPos(ImVec2(x, y));
    ImGui::SetNextWindowSize(ImVec2(width, height));
    const bool open = ImGui::Begin(title, nullptr,
                                   ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize |
                                       ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoCollapse |
                                       ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PushItemWidth(-0.42f * width);
    return open;
}

void ui_panel_end(void)
{
    ImGui::PopItemWidth();
    ImGui::End();
}

bool ui_tabs_begin(const char *name)
{
    return ImGui::BeginTabBar(name, ImGuiTabBarFlags_FittingPolicyScroll);
}

void ui_tabs_end(void)
{
    ImGui::EndTabBar();
}

bool ui_tab_begin(const char *label, bool select)
{
    const bool open =
        ImGui::BeginTabItem(label, nullptr, select ? ImGuiTabItemFlags_SetSelected : 0);
    seen(label, false);
    return open;
}

void ui_tab_end(void)
{
    ImGui::EndTabItem();
}

bool ui_section(const char *label, bool open_at_first)
{
    const bool open =
        ImGui::CollapsingHeader(label, open_at_first ? ImGuiTreeNodeFlags_DefaultOpen : 0);
    return seen(label, open);
}

void ui_push(int id)
{
    ImGui::PushID(id);
}
void ui_pop(void)
{
    ImGui::PopID();
}
void ui_indent(void)
{
    ImGui::Indent();
}
void ui_unindent(void)
{
    ImGui::Unindent();
}

static void wrapped(const ImVec4 &tint, const char *format, va_list arguments)
{
    char text[2048];
    vsnprintf(text, sizeof text, format, arguments);
    ImGui::PushStyleColor(ImGuiCol_Text, tint);
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::PopStyleColor();
}

void ui_text(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    wrapped(ImGui::GetStyleColorVec4(ImGuiCol_Text), format, arguments);
    va_end(arguments);
}

void ui_faint(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    wrapped(ImGui::GetStyleColorVec4(ImGuiCol_TextDisabled), format, arguments);
    va_end(arguments);
}

void ui_warning(const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    wrapped(ImVec4(1.0f, 0.72f, 0.35f, 1.0f), format, arguments);
    va_end(arguments);
}

void ui_tooltip(const char *text)
{
    if (!text || !text[0] || !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
    ImGui::BeginTooltip();
    ImGui::PushTextWrapPos(24.0f * ImGui::GetFontSize());
    ImGui::TextUnformatted(text);
    ImGui::PopTextWrapPos();
    ImGui::EndTooltip();
}

void ui_same_line(void)
{
    ImGui::SameLine();
}
void ui_separator(void)
{
    ImGui::Separator();
}

void ui_progress(double done, const char *text)
{
    ImGui::ProgressBar(static_cast<float>(done), ImVec2(-1, 0), text);
}

void ui_disable(bool disabled)
{
    ImGui::BeginDisabled(disabled);
}
void ui_enable(void)
{
    ImGui::EndDisabled();
}

bool ui_button(const char *label)
{
    return seen(label, ImGui::Button(label));
}
bool ui_small_button(const char *label)
{
    return seen(label, ImGui::SmallButton(label));
}

bool ui_selectable(const char *label, bool selected)
{
    return seen(label, ImGui::Selectable(label, selected));
}

bool ui_switch(const char *label, bool *value)
{
    return seen(label, ImGui::Checkbox(label, value));
}

bool ui_choice(const char *label, int *index, const char *const *names, int count)
{
    bool changed = false;
    const char *shown = *index >= 0 && *index < count ? names[*index] : "";
    const bool open = ImGui::BeginCombo(label, shown, ImGuiComboFlags_HeightLarge);
    seen(label, false);
    if (!open) return false;
    for (int i = 0; i < count; i++) {
        if (!seen(names[i], ImGui::Selectable(names[i], i == *index))) continue;
        changed |= i != *index;
        *index = i;
    }
    ImGui::EndCombo();
    return changed;
}

bool ui_integer(const char *label, int *value, int least, int most)
{
    const bool wide = static_cast<double>(most) - least > 10000.0 && least >= 0;
    return seen(label, ImGui::SliderInt(label, value, least, most, "%d",
                                        ImGuiSliderFlags_AlwaysClamp |
                                            (wide ? ImGuiSliderFlags_Logarithmic : 0)));
}

bool ui_number(const char *label, float *value, float least, float most, const char *format,
               bool logarithmic)
{
    return seen(label, ImGui::SliderFloat(label, value, least, most, format,
                                          ImGuiSliderFlags_AlwaysClamp |
                                              (logarithmic ? ImGuiSliderFlags_Logarithmic : 0)));
}

bool ui_numbers(const char *label, float *values, int count, float step, const char *format)
{
    return seen(label, ImGui::DragScalarN(label, ImGuiDataType_Float, values, count, step, nullptr,
                                          nullptr, format));
}

bool ui_color(const char *label, float rgb[3])
{
    return seen(label, ImGui::ColorEdit3(label, rgb, ImGuiColorEditFlags_Float));
}

bool ui_line(const char *label, char *text, size_t size)
{
    const bool entered = ImGui::InputText(label, text, size, ImGuiInputTextFlags_EnterReturnsTrue);
    return seen(label, entered);
}

bool ui_released(void)
{
    return ImGui::IsItemDeactivatedAfterEdit();
}

// ---- drawing

void ui_stroke(float x0, float y0, float x1, float y1, uint32_t rgba, float width)
{
    ImGui::GetBackgroundDrawList()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color(rgba), width);
}

void ui_box(float x0, float y0, float x1, float y1, uint32_t rgba)
{
    ImGui::GetBackgroundDrawList()->AddRectFilled(ImVec2(x0, y0), ImVec2(x1, y1), color(rgba));
}

void ui_disk(float x, float y, float radius, uint32_t rgba)
{
    ImGui::GetBackgroundDrawList()->AddCircleFilled(ImVec2(x, y), radius, color(rgba));
}

void ui_triangles(const struct ui_vertex *vertices, int vertex_count, const int *indices,
                  int index_count)
{
    ImDrawList *list = ImGui::GetBackgroundDrawList();
    const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
    list->PrimReserve(index_count, vertex_count);
    const unsigned first = list->_VtxCurrentIdx; // after PrimReserve, which may begin a new range
    for (int i = 0; i < index_count; i++)
        list->PrimWriteIdx(static_cast<ImDrawIdx>(first + static_cast<unsigned>(indices[i])));
    for (int i = 0; i < vertex_count; i++)
        list->PrimWriteVtx(ImVec2(vertices[i].x, vertices[i].y), white, color(vertices[i].rgba));
}

void ui_label(float x, float y, uint32_t rgba, const char *text)
{
    ImGui::GetBackgroundDrawList()->AddText(ImVec2(x, y), color(rgba), text);
}

float ui_label_width(const char *text)
{
    return ImGui::CalcTextSize(text).x;
}

struct ui_area ui_area(float height)
{
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    ImGui::InvisibleButton("area", ImVec2(width > 1 ? width : 1, height));
    struct ui_area area;
    area.x = at.x;
    area.y = at.y;
    area.width = width;
    area.height = height;
    area.hovered = ImGui::IsItemHovered();
    area.mouse_x = ImGui::GetIO().MousePos.x;
    area.mouse_y = ImGui::GetIO().MousePos.y;
    return area;
}

void ui_area_box(float x0, float y0, float x1, float y1, uint32_t rgba)
{
    ImGui::GetWindowDrawList()->AddRectFilled(ImVec2(x0, y0), ImVec2(x1, y1), color(rgba));
}

void ui_area_stroke(float x0, float y0, float x1, float y1, uint32_t rgba, float width)
{
    ImGui::GetWindowDrawList()->AddLine(ImVec2(x0, y0), ImVec2(x1, y1), color(rgba), width);
}

void ui_area_text(float x, float y, uint32_t rgba, const char *text)
{
    ImGui::GetWindowDrawList()->AddText(ImVec2(x, y), color(rgba), text);
}
