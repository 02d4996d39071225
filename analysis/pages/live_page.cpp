#include "swiftlet/analysis/pages/live_page.hpp"

#include "swiftlet/analysis/pages/assets.hpp"
#include "swiftlet/analysis/pages/html.hpp"

namespace swiftlet::pages {
namespace {

constexpr const char* kBody = R"(<h1>Swiftlet live</h1>
<p id="state"><span id="connection" role="status">connecting</span> <span id="slow" role="status"></span> <span id="answers" role="status"></span></p>
<div class="controls">
<button type="button" id="hold-all">Hold all</button>
<button type="button" id="land-all">Land all</button>
<span class="group" role="group" aria-label="picture">
<button type="button" id="home">Reset view</button>
<button type="button" id="map">Map</button>
</span>
<label>last <select id="window">
<option value="30">30 s</option><option value="120">2 min</option><option value="600">10 min</option>
</select></label>
<button type="button" id="follow" aria-pressed="true">Follow</button>
<button type="button" id="stop-all" class="danger">Stop all</button>
</div>
<div class="top"><div id="scene" class="live"></div><div id="vehicles"></div></div>
<h2>Signals</h2>
<form id="add-signal" class="controls-row">
<label>topic <select id="topic"></select></label>
<label>signal <select id="signal"></select></label>
<button type="submit">Add chart</button>
</form>
<p class="quiet">Drag in a chart to zoom all charts, with Shift to move; Follow shows the newest again. Dashed lines are references.
Drag in the picture to turn it, Ctrl and wheel to zoom. Vehicles are drawn larger than they are.</p>
<div id="charts" class="grid"></div>
<h2>Events</h2>
<div id="events" tabindex="0" role="region" aria-label="events"></div>
<dialog id="confirm" aria-labelledby="confirm-title"><form method="dialog">
<h2 id="confirm-title"></h2>
<p id="confirm-text"></p>
<button value="no" id="confirm-no">Cancel</button>
<button value="yes" id="confirm-yes">Yes</button>
</form></dialog>
)";

}  // namespace

std::string live_page() {
  return document("Swiftlet live", kBody, {chart_scripts(), scene_scripts(), live_scripts()});
}

}  // namespace swiftlet::pages
