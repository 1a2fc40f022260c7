// SPDX-License-Identifier: GPL-2.0-or-later
// libavformat around one stream of libavcodec. Same frames, same bytes: a fixed number of threads,
// no date, no name of an encoder. libav prints what it meets; here it is told to be silent.
#include "io/video/video_file_module.h"

#include "base/memory.h"
#include "base/transfer.h"
#include "io/files/own_mark.h"

#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
#include <libswscale/swscale.h>

#include <errno.h>
#include <string.h>
#include <strings.h>
#include <unistd.h>

enum { THREADS = 2, BUFFER_SIZE = 1 << 16, GIF_TICKS = 100, PALETTE_SIZE = 256 };
enum { SIDE_BITS = 5, SIDE = 1 << SIDE_BITS };   // of the cube that colours are looked up in

// What becomes of a name: libav's format and encoder, and options of the latter. The quality was
// chosen by eye, on thin lines and on the colours of a field.
typedef struct VideoKind {
    const char *ending, *format, *encoder, *name;
    enum AVPixelFormat pixels;
    const char *options[4][2];
} VideoKind;

static const VideoKind kinds[] = {
    {".mp4",
     "mp4",
     "libx264",
     "H.264",
     AV_PIX_FMT_YUV420P,
     {{"preset", "veryfast"}, {"crf", "18"}}},
    {".webm",
     "webm",
     "libvpx-vp9",
     "VP9",
     AV_PIX_FMT_YUV420P,
     {{"deadline", "realtime"}, {"cpu-used", "7"}, {"row-mt", "1"}, {"crf", "24"}}},
    {".gif", "gif", "gif", "GIF", AV_PIX_FMT_PAL8, {{0}}}};

struct VideoStream {
    AVFormatContext *format;   // owned, like all
    AVIOContext *io;
    AVCodecContext *codec;
    AVStream *track;   // the format's
    AVFrame *frame;
    AVPacket *packet;
    struct SwsContext *scaler;   // NULL: of a GIF
    uint32_t palette[PALETTE_SIZE];
    uint8_t *nearest;   // [SIDE^3] entry of the palette by blue, green, red
    int descriptor, write_errno;   // write_errno: 0: all was written so far
    int64_t frames;
    int log_level;   // libav's, as it was found
};

// --- the file ------------------------------------------------------------------------------------

static int bytes_write(void *self, uint8_t *bytes, int size)
{
    VideoStream *stream = self;
    int cause = transfer_write(stream->descriptor, bytes, size, -1);
    if (cause) stream->write_errno = cause;
    return cause ? AVERROR(cause) : size;
}

static int64_t place_seek(void *self, int64_t offset, int whence)
{
    VideoStream *stream = self;
    if (whence & AVSEEK_SIZE) return -1;
    return lseek(stream->descriptor, offset, whence & ~AVSEEK_FORCE);
}

// What libav says, or the disk where that failed.
static bool check(VideoStream *stream, int code, const char *what, Error *err)
{
    char words[AV_ERROR_MAX_STRING_SIZE] = "";
    if (stream->write_errno)
        return FAULT(err, ERROR_FILE, "cannot write: %s", strerror(stream->write_errno));
    if (code == AVERROR(ENOMEM)) return FAULT(err, ERROR_MEMORY, "no memory for libav");
    if (code < 0) {
        av_strerror(code, words, sizeof words);
        return FAULT(err, ERROR_LIBRARY, "libav %s: %s", what, words);
    }
    return true;
}

// --- begin ---------------------------------------------------------------------------------------

static const VideoKind *find_kind(const char *path)
{
    const char *dot = strrchr(path, '.');
    for (size_t k = 0; dot && k < sizeof kinds / sizeof *kinds; ++k)
        if (strcasecmp(kinds[k].ending, dot) == 0) return &kinds[k];
    return NULL;
}

// The name is asked once more, to move the index of an .mp4 to its front; "file:" keeps a colon in
// it from being taken for a protocol.
static bool format_open(VideoStream *stream, const VideoKind *kind, const VideoTarget *target,
                        Error *err)
{
    char url[4200];
    snprintf(url, sizeof url, "file:%s", target->part);
    if (!check(stream, avformat_alloc_output_context2(&stream->format, NULL, kind->format, url),
               "makes no such file", err))
        return false;
    uint8_t *buffer = av_malloc(BUFFER_SIZE);
    if (buffer)
        stream->io =
            avio_alloc_context(buffer, BUFFER_SIZE, 1, stream, NULL, bytes_write, place_seek);
    if (!stream->io) av_free(buffer);
    if (!check(stream, stream->io ? 0 : AVERROR(ENOMEM), "", err)) return false;
    stream->format->pb = stream->io;
    stream->format->flags |= AVFMT_FLAG_BITEXACT;
    return true;
}

// Colours of video are those of BT.709, which is what players take for granted of HD.
static bool codec_open(VideoStream *stream, const VideoKind *kind, const VideoDef *def, Error *err)
{
    AVDictionary *options = NULL;
    const AVCodec *encoder = avcodec_find_encoder_by_name(kind->encoder);
    if (!encoder)
        FAIL(err, ERROR_LIBRARY,
             "libav has no encoder %s here, which makes %s (%s); try another ending: .mp4, .webm, "
             ".gif, or a folder of PNG frames",
             kind->encoder, kind->ending, kind->name);
    stream->codec = avcodec_alloc_context3(encoder);
    TRY(check(stream, stream->codec ? 0 : AVERROR(ENOMEM), "", err));
    AVCodecContext *codec = stream->codec;
    codec->width = def->width;
    codec->height = def->height;
    codec->pix_fmt = kind->pixels;
    codec->time_base = (AVRational){1, def->rate};
    codec->framerate = (AVRational){def->rate, 1};
    codec->gop_size = 2 * def->rate;   // a viewer may jump to every other second
    codec->thread_count = THREADS;
    codec->flags |= AV_CODEC_FLAG_BITEXACT;
    if (stream->format->oformat->flags & AVFMT_GLOBALHEADER)
        codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
    if (kind->pixels == AV_PIX_FMT_YUV420P) {
        codec->colorspace = AVCOL_SPC_BT709;
        codec->color_primaries = AVCOL_PRI_BT709;
        codec->color_trc = AVCOL_TRC_BT709;
        codec->color_range = AVCOL_RANGE_MPEG;
    }
    for (int32_t k = 0; k < 4 && kind->options[k][0]; ++k)
        av_dict_set(&options, kind->options[k][0], kind->options[k][1], 0);
    TRY(check(stream, avcodec_open2(codec, encoder, &options), "does not start its encoder", err));
cleanup:
    av_dict_free(&options);
    return error_is_clean(err);
}

// The file's own frames and their way from what is drawn.
static bool frame_create(VideoStream *stream, const VideoKind *kind, const VideoDef *def,
                         Error *err)
{
    stream->frame = av_frame_alloc();
    stream->packet = av_packet_alloc();
    if (!check(stream, stream->frame && stream->packet ? 0 : AVERROR(ENOMEM), "", err))
        return false;
    stream->frame->format = kind->pixels;
    stream->frame->width = def->width;
    stream->frame->height = def->height;
    if (!check(stream, av_frame_get_buffer(stream->frame, 0), "has no frame", err)) return false;
    if (kind->pixels == AV_PIX_FMT_PAL8) return true;
    stream->scaler = sws_getContext(def->width, def->height, AV_PIX_FMT_BGR0, def->width,
                                    def->height, kind->pixels, SWS_BILINEAR, NULL, NULL, NULL);
    if (!check(stream, stream->scaler ? 0 : AVERROR(ENOMEM), "", err)) return false;
    const int *hd = sws_getCoefficients(SWS_CS_ITU709);
    sws_setColorspaceDetails(stream->scaler, hd, 1, hd, 0, 0, 1 << 16, 1 << 16);
    return true;
}

static bool track_open(VideoStream *stream, const VideoDef *def, Error *err)
{
    AVDictionary *options = NULL;
    stream->track = avformat_new_stream(stream->format, NULL);
    TRY(check(stream, stream->track ? 0 : AVERROR(ENOMEM), "", err));
    stream->track->time_base = stream->codec->time_base;
    stream->track->avg_frame_rate = stream->codec->framerate;
    TRY(check(stream, avcodec_parameters_from_context(stream->track->codecpar, stream->codec),
              "describes no stream", err));
    av_dict_set(&options, "movflags", "+faststart", 0);   // others do not know it
    av_dict_set(&stream->format->metadata, "comment", OWN_FILM, 0);
    if (def->title && def->title[0]) av_dict_set(&stream->format->metadata, "title", def->title, 0);
    TRY(check(stream, avformat_write_header(stream->format, &options), "writes no header", err));
cleanup:
    av_dict_free(&options);
    return error_is_clean(err);
}

// The nearest entry of the palette to the middle of each of SIDE^3 cubes of colours.
static bool palette_fill(VideoStream *stream, const uint8_t *colors, Error *err)
{
    if (!(stream->nearest = NEW_ARRAY(uint8_t, SIDE * SIDE * SIDE, err))) return false;
    for (int32_t k = 0; k + 1 < PALETTE_SIZE; ++k)   // the last one stays transparent
        stream->palette[k] = 0xff000000u | (uint32_t)colors[3 * k] << 16 |
                             (uint32_t)colors[3 * k + 1] << 8 | colors[3 * k + 2];
    for (int32_t cube = 0; cube < SIDE * SIDE * SIDE; ++cube) {
        int32_t least = INT32_MAX, at[3];
        for (int32_t c = 0; c < 3; ++c)   // the ends of the range are themselves
            at[c] = ((cube >> SIDE_BITS * (2 - c)) % SIDE * 255 + SIDE / 2) / (SIDE - 1);
        for (int32_t k = 0; k + 1 < PALETTE_SIZE; ++k) {
            int32_t away = 0;
            for (int32_t c = 0; c < 3; ++c)
                away += (colors[3 * k + c] - at[c]) * (colors[3 * k + c] - at[c]);
            if (away >= least) continue;
            least = away;
            stream->nearest[cube] = (uint8_t)k;
        }
    }
    return true;
}

static void stream_destroy(VideoStream *stream)
{
    if (!stream) return;
    avcodec_free_context(&stream->codec);
    av_frame_free(&stream->frame);
    av_packet_free(&stream->packet);
    sws_freeContext(stream->scaler);
    avformat_free_context(stream->format);
    if (stream->io) av_freep(&stream->io->buffer);
    avio_context_free(&stream->io);
    av_log_set_level(stream->log_level);
    memory_free_all(stream->nearest, stream);
}

static VideoStream *stream_create(const VideoDef *def, const VideoTarget *target, Error *err)
{
    const VideoKind *kind = find_kind(def->path);
    VideoStream *stream = NEW_ARRAY(VideoStream, 1, err);
    TRY(stream);
    stream->descriptor = target->descriptor;
    stream->log_level = av_log_get_level();
    av_log_set_level(AV_LOG_QUIET);
    if (!kind) FAIL(err, ERROR_INPUT, "a film's name ends in .mp4, .webm or .gif");
    if (kind->pixels == AV_PIX_FMT_PAL8 && GIF_TICKS % def->rate != 0)
        FAIL(err, ERROR_INPUT,
             "%d frames a second: a GIF counts hundredths of a second, so 10, 20, 25 or 50",
             def->rate);
    if (kind->pixels == AV_PIX_FMT_PAL8) TRY(palette_fill(stream, def->palette, err));
    TRY(format_open(stream, kind, target, err));
    TRY(codec_open(stream, kind, def, err));
    TRY(frame_create(stream, kind, def, err));
    TRY(track_open(stream, def, err));
    return stream;
cleanup:
    stream_destroy(stream);
    return NULL;
}

// --- frames --------------------------------------------------------------------------------------

// All that the encoder has ready goes into the file.
static bool packets_write(VideoStream *stream, Error *err)
{
    for (;;) {
        int code = avcodec_receive_packet(stream->codec, stream->packet);
        if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return true;
        if (!check(stream, code, "cannot encode a frame", err)) return false;
        if (stream->packet->duration <= 0) stream->packet->duration = 1;   // frame
        av_packet_rescale_ts(stream->packet, stream->codec->time_base, stream->track->time_base);
        stream->packet->stream_index = stream->track->index;
        code = av_interleaved_write_frame(stream->format, stream->packet);
        if (!check(stream, code, "cannot write a frame", err)) return false;
    }
    return true;
}

static void frame_index(VideoStream *stream, const uint8_t *pixels, int32_t stride)
{
    enum { DROP = 8 - SIDE_BITS };   // bits of a colour's part
    memcpy(stream->frame->data[1], stream->palette, sizeof stream->palette);
    for (int32_t row = 0; row < stream->frame->height; ++row) {
        const uint8_t *from = pixels + (int64_t)row * stride;
        uint8_t *to = stream->frame->data[0] + (int64_t)row * stream->frame->linesize[0];
        for (int32_t k = 0; k < stream->frame->width; ++k, from += 4)
            to[k] = stream->nearest[(from[2] >> DROP) << 2 * SIDE_BITS |
                                    (from[1] >> DROP) << SIDE_BITS | from[0] >> DROP];
    }
}

static bool stream_add(VideoStream *stream, const uint8_t *pixels, int32_t stride, Error *err)
{
    AVFrame *frame = stream->frame;
    if (!check(stream, av_frame_make_writable(frame), "has no frame", err)) return false;
    if (stream->scaler)
        sws_scale(stream->scaler, (const uint8_t *const[]){pixels}, &stride, 0, frame->height,
                  frame->data, frame->linesize);
    else
        frame_index(stream, pixels, stride);
    frame->pts = stream->frames++;
    return check(stream, avcodec_send_frame(stream->codec, frame), "cannot encode a frame", err) &&
           packets_write(stream, err);
}

// GIF89a, 24: a comment before the last byte; libav has none.
static void gif_sign(VideoStream *stream)
{
    uint8_t words[] = OWN_FILM, head[] = {'!', 0xfe, sizeof words - 1}, tail[] = {0, ';'};
    lseek(stream->descriptor, -1, SEEK_END);
    bytes_write(stream, head, sizeof head);
    bytes_write(stream, words, sizeof words - 1);
    bytes_write(stream, tail, sizeof tail);
}

static bool stream_finish(VideoStream *stream, Error *err)
{
    if (!check(stream, avcodec_send_frame(stream->codec, NULL), "cannot end the film", err))
        return false;
    if (!packets_write(stream, err)) return false;
    if (!check(stream, av_write_trailer(stream->format), "cannot end the file", err)) return false;
    avio_flush(stream->io);
    if (strcmp(stream->format->oformat->name, "gif") == 0) gif_sign(stream);
    return check(stream, stream->io->error, "cannot end the file", err);
}

__attribute__((visibility("default"))) const VideoModule *amontons_video_module(void)
{
    static const VideoModule module = {stream_create, stream_add, stream_finish, stream_destroy};
    return &module;
}
